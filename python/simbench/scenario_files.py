"""Scenarios and algorithms: what there is, what they mean, whether a file is right."""

from __future__ import annotations

import json
import os
from typing import Any, List, Mapping, Optional, Sequence, Union

from . import _simbench
from .command import Paths, paths_of, run_command, sets_of, words_of
from .results import Path, use_python
from .tables import table



def list_scenarios() -> Any:
    """The built-in scenarios: scenario, summary. A pandas DataFrame; else a list of dicts."""
    return table(_simbench.list_scenarios())


def listing(
    what: str = "scenarios",
    *,
    scenario: Optional[Path] = None,
    python: Union[Path, Sequence[Path]] = (),
) -> List[str]:
    """The names of what there is, as `simbench list WHAT --format names` prints them.

    what: "scenarios", "pipelines" (of a scenario, by default 18cam_6host_45fps), "algorithms",
        "cameras", "oscillators", "parts", "studies" or "figures".
    python: files with algorithms, which are imported first.
    """
    use_python(python)
    options = words_of(scenario=scenario, format="names")
    return run_command("list", options, [what]).output.split()


def describe(
    scenario: Path,
    prefix: Optional[str] = None,
    *,
    set: Optional[Mapping[str, Any]] = None,
    python: Union[Path, Sequence[Path]] = (),
) -> Any:
    """Every parameter of a scenario or of an algorithm, with unit, meaning and source.

    scenario: a name, the path of a JSON file, or the name of an algorithm or its family.
    prefix: only parameters of the scenario whose pointers begin so. set: changes of the scenario.
    python: files with algorithms, which are imported first.

    Of a scenario: pointer, value, unit, meaning, source; of algorithms: algorithm, stage, name,
    default, low, high, unit, meaning, source. A pandas DataFrame; else a list of dicts.
    """
    use_python(python)
    name, sets = os.fspath(scenario), sets_of(set)
    words = [name] if prefix is None else [name, prefix]
    pointers = run_command("describe", words_of(set=sets, format="names"), words).output.split()
    if all(pointer.startswith("/") for pointer in pointers) and pointers:
        pairs = [(pointer, json.dumps(value)) for pointer, value in (set or {}).items()]
        return table([line for line in _simbench.describe(name, pairs)
                      if line["pointer"] in pointers])
    found = json.loads(run_command("describe", words_of(format="json"), words).output)
    return table([{"algorithm": each["name"], "stage": each["stage"], **parameter}
                  for each in found for parameter in each["parameters"]])


def validate(files: Paths, *, python: Union[Path, Sequence[Path]] = ()) -> List[str]:
    """Checks scenario files without running them, as `simbench validate` does, and returns what is
    doubtful in them, a line each. Raises InputError, with a line for each that is wrong.

    files: paths of JSON files. python: files with algorithms, which are imported first.
    """
    use_python(python)
    return run_command("validate", [], paths_of("files", files)).notes
