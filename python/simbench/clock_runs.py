"""The hosts' clocks alone."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

from . import _simbench, curves
from .progress import Progress
from .results import Path, _add_programs, _warn, _whole, request_of, use_python
from .tables import notebook_html, page_text, records, table


class Clocks(curves.HasCurves):
    """Time error, stability and holdover of the hosts' clocks: what `simbench clocks` prints.

    adev, mdev, hdev (no unit), tdev_ms and mtie_ms are curves over tau: pipeline, tau_s, value.
    """

    def __init__(self, run: _simbench.ClockRun) -> None:
        self._run = run

    @property
    def notes(self) -> List[str]:
        """What is doubtful about the results, a line each; mostly empty."""
        return self._run.notes

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as `simbench clocks --format json` prints it."""
        return dict(json.loads(self._run.json()))

    @property
    def table(self) -> Any:
        """A row a pipeline, with the median of each metric, whose unit its name ends with."""
        rows: Dict[str, Dict[str, Any]] = {}
        for line in records(self._run.csv()):
            row = rows.setdefault(line["pipeline"], {"pipeline": line["pipeline"]})
            if line["tau_s"] != line["tau_s"]:  # NaN: a metric, and no point of a curve
                row[line["measure"]] = line["value"]
        return table(list(rows.values()))

    @property
    def seeds(self) -> Any:
        """Every value: scenario, pipeline, seed, metric, unit, value."""
        return table(records(self._run.tidy_csv()))

    @property
    def time_errors(self) -> Any:
        """The time errors of the first seed's slaves: pipeline, seed, time_s, host, te_s."""
        return table(records(self._run.series_csv()))

    def curve(self, measure: str) -> Any:
        """The points of a curve, `measure`: adev, mdev, hdev, tdev_ms or mtie_ms. A row a point:
        pipeline, tau_s, value."""
        return table([{"pipeline": pipeline, **point}
                      for pipeline, points in self._points(measure).items() for point in points])

    def _points(self, measure: str) -> Dict[str, List[Dict[str, Any]]]:
        curves.check_measure(measure)
        found: Dict[str, List[Dict[str, Any]]] = {}
        for line in records(self._run.csv()):
            if line["measure"] == measure and line["tau_s"] == line["tau_s"]:
                point = {"tau_s": line["tau_s"], "value": line["value"]}
                found.setdefault(line["pipeline"], []).append(point)
        return found

    def plot(self, measure: str = "adev", ax: Any = None) -> Any:
        """A curve over tau on logarithmic axes, a line a pipeline. `measure`: adev, mdev, hdev,
        tdev_ms or mtie_ms. Returns matplotlib's axes; `ax`: where to draw."""
        return curves.draw(self._points(measure), measure, ax)

    @property
    def dataset(self) -> Any:
        """An xarray.Dataset of the shape (pipeline, tau_s) with adev, mdev, hdev (no unit), tdev_ms
        and mtie_ms. NaN: no such value at this tau."""
        return self.to_xarray()

    def to_xarray(self) -> Any:
        """See `dataset`. Raises MissingPackage without xarray."""
        return curves.dataset(
            "pipeline", {each: self._points(each) for each in curves.CURVES}, False
        )

    def save(self, folder: Path) -> None:
        """Writes the archive that `simbench clocks --output` writes."""
        self._run.save(os.fspath(folder))

    def __repr__(self) -> str:
        return page_text(self._run.text)

    def _repr_html_(self) -> str:
        return notebook_html(self._run.html())


def clocks(
    scenario: Path,
    pipelines: Optional[Sequence[str]] = None,
    seeds: int = 8,
    *,
    duration_s: Optional[int] = None,
    from_s: int = 300,
    set: Optional[Mapping[str, Any]] = None,
    first_seed: int = 1,
    jobs: int = 0,
    program: Union[str, Sequence[str]] = (),
    program_log: Optional[Path] = None,
    python: Union[Path, Sequence[Path]] = (),
    figure: Optional[Path] = None,
    progress: Optional[bool] = None,
) -> Clocks:
    """Runs the hosts' clocks alone, as `simbench clocks` does: from a cold start for duration_s
    seconds, then 600 s without the master and 3600 s with it again.

    scenario, pipelines, seeds, first_seed, set, jobs, program, program_log, python: as for run().
    duration_s: None: 36000; with real programs from 360 to 3600, mostly 600, and no loss.
    from_s: the second from which spread, errors and stability count.
    figure: a .svg or .pdf file to draw ADEV, TDEV and MTIE to, by gnuplot.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    use_python(python)
    request = request_of("clocks", scenario, pipelines, seeds, first_seed, set, jobs)
    _add_programs(request, program, program_log)
    most = 31_000_000
    duration = None if duration_s is None else _whole("duration_s", duration_s, 1, most)
    start = _whole("from_s", from_s, 0, most)
    with Progress(progress, "run") as shown:
        result = Clocks(_simbench.run_clocks(request, duration, start, shown.callback))
    _warn(result.notes)
    if figure is not None:
        result._run.draw(os.fspath(figure))
    return result
