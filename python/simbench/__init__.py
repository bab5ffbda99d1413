"""simbench: how well cameras on hosts over a network are synchronised, and what limits it.

    import simbench
    r = simbench.run("18cam_6host_45fps", pipelines=["yoon2021_both"], seeds=8)
    r.table                       # a row a pipeline
    r.frames("yoon2021_both")     # every frame: stamps, truth, error
    r.plot()

All of it is what the command `simbench` computes, with the same numbers. docs/python.md explains it.
"""

from __future__ import annotations

import os
import sys
from typing import Any

from . import _simbench
from .algorithms import (
    Frame, Parameter, Sample, capture_alignment, device_time, gathering, host_sync, pipeline,
)  # fmt: skip
from .clock_runs import Clocks, clocks
from .errors import Error, InputError, MissingPackage, OutputError
from .recordings import write_recording
from .results import Comparison, Result, compare, load, run
from .rigs import Diagnosis, Inspection, diagnose, inspect, replay
from .tables import table as _table

_folder = os.path.dirname(os.path.abspath(__file__))
_command = f"import sys; sys.path.insert(0, {os.path.dirname(_folder)!r}); " \
    "from simbench.__main__ import main; sys.exit(main())"
_simbench.use_programs(sys.executable or "python3", ["-c", _command], _folder)
__version__: str = _simbench.version

__all__ = [
    "Clocks", "Comparison", "Diagnosis", "Error", "Frame", "InputError", "Inspection",
    "MissingPackage", "OutputError", "Parameter", "Result", "Sample", "capture_alignment", "clocks",
    "compare", "describe", "device_time", "diagnose", "gathering", "host_sync", "inspect",
    "list_scenarios", "load", "pipeline", "replay", "run", "write_recording",
]  # fmt: skip


def list_scenarios() -> Any:
    """The built-in scenarios: scenario, summary. A pandas DataFrame; else a list of dicts."""
    return _table(_simbench.list_scenarios())


def describe(scenario: "str | os.PathLike[str]") -> Any:
    """Every parameter of a scenario: pointer, value, unit, meaning, source. As list_scenarios()."""
    return _table(_simbench.describe(os.fspath(scenario)))
