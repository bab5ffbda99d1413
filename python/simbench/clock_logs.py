"""How stable a measured clock is, from logs of other programs, as `simbench stability` does."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Optional, Sequence, Union

from . import curves
from .command import Output, Paths, joined, paths_of, run_command, words_of
from .results import Path
from .tables import table


class Stability(curves.HasCurves, Output):
    """Allan, modified Allan, Hadamard and time deviation, MTIE and time error of measured clocks.

    adev, mdev, hdev (no unit), tdev_ms and mtie_ms are curves over tau: file, tau_s, value, the 95 %
    interval low to high, terms (independent differences), noise (the power law), reliable.
    """

    formats = ("table", "markdown", "csv", "json", "html")

    @property
    def table(self) -> Any:
        """A row a file, with what is a single value: interval_s, points, gaps, max_te_ms, rms_te_ms,
        constant_te_ms, p95_te_ms, ..."""
        rows = []
        for file in self._files:
            rows.append({name: value for name, value in file.items()
                         if not isinstance(value, (list, dict)) and name != "start"})
        return table(rows)

    @property
    def verdicts(self) -> Any:
        """What the mask and the limits say: a row a limit, with file, mask, label, quantity,
        judgement ("passes", "fails", "cannot_tell"), tau_s, and value and allowed in the unit of the
        quantity."""
        return table([{"file": file["file"], "mask": verdict["mask"], **limit}
                      for file in self._files for verdict in file["verdicts"]
                      for limit in verdict["limits"]])

    @property
    def passed(self) -> Optional[bool]:
        """Whether no limit is broken; None without `mask` and `limit`."""
        judged = [verdict["judgement"] for file in self._files for verdict in file["verdicts"]]
        return "fails" not in judged if judged else None

    @property
    def steps(self) -> Any:
        """Where a clock was set: file, at_s since its first point, step_ms."""
        return table([{"file": file["file"], **step}
                      for file in self._files for step in file["steps"]])

    def curve(self, measure: str) -> Any:
        """The points of a curve, `measure`: adev, mdev, hdev, tdev_ms or mtie_ms. A row a point."""
        return table([{"file": file, **point}
                      for file, points in self._points(measure).items() for point in points])

    @property
    def dataset(self) -> Any:
        """An xarray.Dataset of the shape (file, tau_s): adev, adev_low, adev_high, ..., mtie_ms.
        NaN: no such value at this tau."""
        return self.to_xarray()

    def to_xarray(self) -> Any:
        """See `dataset`. Raises MissingPackage without xarray."""
        return curves.dataset("file", {each: self._points(each) for each in curves.CURVES}, True)

    def plot(self, measure: str = "adev", ax: Any = None) -> Any:
        """A curve over tau on logarithmic axes, a line a file, with its 95 % interval. `measure`:
        adev, mdev, hdev, tdev_ms or mtie_ms. Returns matplotlib's axes; `ax`: where to draw."""
        return curves.draw(self._points(measure), measure, ax)

    def _points(self, measure: str) -> Dict[str, curves.Points]:
        curves.check_measure(measure)
        return {file["file"]: file[measure] for file in self._files}

    @property
    def _files(self) -> List[Dict[str, Any]]:
        return list(self.data["files"])


def _reading(unit: Optional[str], time_unit: Optional[str]) -> Dict[str, Any]:
    return {"unit": unit, "time_unit": time_unit}


def stability(
    files: Paths,
    *,
    unit: Optional[str] = None,
    time_unit: Optional[str] = None,
    series: Optional[str] = None,
    interval_s: Optional[float] = None,
    frequencies: bool = False,
    locked: bool = False,
    from_: Union[float, str, None] = None,
    until: Union[float, str, None] = None,
    settle: bool = False,
    remove_frequency: bool = False,
    mask: Optional[str] = None,
    limit: Sequence[str] = (),
    figure: Optional[Path] = None,
    html: Optional[Path] = None,
) -> Stability:
    """Says how stable measured clocks are, of logs of ptp4l, chrony, ntpd and others, and of tables.

    files: one or more, a clock each. unit: of the time errors of tables whose headings state none,
        "s", "ms", "us", "ns" or "ps"; time_unit: of their times, also ticks ("8ns").
    series: which of a file that has several (clock_series()).
    interval_s: the distance of points in s; None: the median of the file.
    frequencies: the table has fractional frequencies.
    locked: without the points before the servo locked. settle: without the start, of a clock that
        was not set yet. from_, until: without what is before and behind, in s since the first point
        or as a time (ISO 8601).
    remove_frequency: remove the frequency offset before anything else.
    mask: limits of ITU-T ("class_b", "prtc_a", ...); limit: your own, ["max_te=100ns",
        "mtie@10s=50ns", "adev@1s=1e-9"]. A limit that is broken is no exception: Stability.passed.
    figure: a .svg or .pdf file to draw ADEV, TDEV and MTIE to, by gnuplot. html: a file for the page
        with these and the time error.
    """
    options = words_of(
        **_reading(unit, time_unit), series=series, interval_s=interval_s,
        frequencies=bool(frequencies), locked=bool(locked), from_=from_, until=until,
        settle=bool(settle), remove_frequency=bool(remove_frequency), mask=mask,
        limit=joined("limit", limit), figure=figure, html=html,
    )  # fmt: skip
    return Stability(run_command("stability", options, paths_of("files", files),
                                 formats=Stability.formats))


def clock_series(
    files: Paths, *, unit: Optional[str] = None, time_unit: Optional[str] = None
) -> Any:
    """The series of logs that have several, as `simbench stability FILE --series` lists them: file,
    name, format, points, first_s, last_s. `files`, `unit` and `time_unit` as for stability()."""
    options = [*words_of(**_reading(unit, time_unit)), "--series"]
    ended = run_command("stability", options, paths_of("files", files), formats=["json"])
    return table([{"file": file["file"], **series}
                  for file in json.loads(ended.results["json"])["files"]
                  for series in file["series"]])
