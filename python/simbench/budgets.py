"""What an error comes from, stage by stage: `simbench run --budget`."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

from .algorithms import Pipeline
from .command import Output, repeated, run_command, words_of
from .results import Path, _whole, changes_of, use_python
from .tables import table


class Budget(Output):
    """Each pipeline's error divided among the stages that cause it, and that of its host clocks
    between the world and the algorithm."""

    formats = ("table", "markdown", "latex", "json", "html")

    @property
    def table(self) -> Any:
        """A row a pipeline, metric and part: pipeline, metric ("amd_ms", "absolute_error_ms",
        "host_error_ms"), part ("total", "remainder", a stage, or a cause), and mean, p05 and p95 over
        the seeds in ms."""
        rows = []
        for found in self.data["budgets"]:
            for metric, divided in found.items():
                if not metric.endswith("_ms") or not isinstance(divided, dict):
                    continue
                parts = {name: divided[name] for name in ("total", "algorithm", "remainder")
                         if isinstance(divided.get(name), dict)}
                parts.update({each["stage"]: each for each in divided.get("stages") or []})
                parts.update({each["part"]: each for each in divided.get("parts") or []})
                rows += [{"pipeline": found["pipeline"], "metric": metric, "part": part,
                          **{name: values.get(name) for name in ("mean", "p05", "p95")}}
                         for part, values in parts.items()]
        return table(rows)


def budget(
    scenario: Path,
    pipelines: Optional[Sequence[Union[str, Pipeline]]] = None,
    seeds: int = 32,
    *,
    set: Optional[Mapping[str, Any]] = None,
    first_seed: int = 1,
    jobs: int = 0,
    program: Union[str, Sequence[str]] = (),
    python: Union[Path, Sequence[Path]] = (),
    progress: Optional[bool] = None,
) -> Budget:
    """Divides each pipeline's error among the stages that cause it (136 runs for every seed).

    scenario, pipelines, seeds, first_seed, set, jobs, program, python: as for run().
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    use_python(python)
    names, changes = changes_of("budget", scenario, pipelines, set)
    options = words_of(
        scenario=scenario, pipelines=names, seeds=_whole("seeds", seeds, 1, 1_000_000),
        first_seed=first_seed, set=changes, jobs=_whole("jobs", jobs, 0, 4096) or None,
        program=repeated("program", program), budget=True,
    )  # fmt: skip
    return Budget(run_command("run", options, formats=Budget.formats, progress=progress))
