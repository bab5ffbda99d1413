"""simbench: how well cameras on hosts over a network are synchronised, and what limits it.

    import simbench
    r = simbench.run("18cam_6host_45fps", pipelines=["yoon2021_both"], seeds=8)
    r.table                       # a row a pipeline
    r.frames("yoon2021_both")     # every frame: stamps, truth, error
    r.plot()
    s = simbench.sweep("3cam_1host_30fps", {"/usb/delivery_jitter_transfers": [0, 0.5, 1]})
    s.dataset                     # xarray: axis, pipeline, seed

All of it is what the command `simbench` computes, with the same numbers; functions and arguments
have the names of the commands and their options. docs/python.md explains it.
"""

from __future__ import annotations

import os
import sys

from . import platforms

platforms.load()  # before all that needs the module

from . import _simbench
from .advice import Advice, advise
from .algorithms import (
    Frame, Parameter, Sample, capture_alignment, device_time, gathering, host_sync, pipeline,
)  # fmt: skip
from .budgets import Budget, budget
from .certificates import Certificates, certify
from .clock_logs import Stability, clock_series, stability
from .clock_runs import Clocks, clocks
from .errors import Error, InputError, MissingPackage, OutputError
from .files import Trace, convert_ibl, export, figure, record, report, trace
from .fits import Fit, fit
from .gates import Gate, gate, save_baseline
from .recordings import write_recording
from .results import Comparison, Result, compare, load, run
from .rigs import Diagnosis, Inspection, diagnose, inspect, replay
from .scenario_files import describe, list_scenarios, listing, validate
from .studies import Paper, Reality, paper, reality
from .sweeps import Sweep, sweep

_folder = os.path.dirname(os.path.abspath(__file__))
_command = f"import sys; sys.path.insert(0, {os.path.dirname(_folder)!r}); " \
    "from simbench.__main__ import main; sys.exit(main())"
_simbench.use_programs(sys.executable or "python3", ["-c", _command], _folder)
__version__: str = _simbench.version

__all__ = [
    "Advice", "Budget", "Certificates", "Clocks", "Comparison", "Diagnosis", "Error", "Fit",
    "Frame", "Gate", "InputError", "Inspection", "MissingPackage", "OutputError", "Paper",
    "Parameter", "Reality", "Result", "Sample", "Stability", "Sweep", "Trace", "advise", "budget",
    "capture_alignment", "certify", "clock_series", "clocks", "compare", "convert_ibl", "describe",
    "device_time", "diagnose", "export", "figure", "fit", "gate", "gathering", "host_sync",
    "inspect", "list_scenarios", "listing", "load", "paper", "pipeline", "reality", "record",
    "replay", "report", "run", "save_baseline", "stability", "sweep", "trace", "validate",
    "write_recording",
]  # fmt: skip
