"""Recordings of real cameras: scores, inspection and diagnosis."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, List, Optional, Sequence, Union

from . import _simbench
from .progress import Progress
from .results import Path, Result, _warn
from .tables import array, notebook_html, page_text, paragraphs, table

Paths = Union[Path, Sequence[Path]]


def _paths(of: Paths) -> List[str]:
    if isinstance(of, (str, os.PathLike)):
        return [os.fspath(of)]
    return [os.fspath(path) for path in of]


class Inspection:
    """What recordings have: what `simbench inspect` prints."""

    def __init__(self, inspection: _simbench.Inspection) -> None:
        self._inspection = inspection

    @property
    def notes(self) -> List[str]:
        """What was left out, a line each."""
        return self._inspection.notes

    @property
    def streams(self) -> List[Dict[str, str]]:
        """The streams, in the order of the field `camera` of frames(): camera, host, stream."""
        return self._inspection.streams

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as `simbench inspect --format json` prints it."""
        return json.loads(self._inspection.json())

    @property
    def table(self) -> Any:
        """A row a stream."""
        return table([stream for file in self.data["files"] for stream in file["streams"]])

    def frames(self, device_times: Sequence[str] = ()) -> Any:
        """Every frame: a structured NumPy array, read-only, in the memory of the libraries.

        Fields: camera (its place in `streams`), counter, sensor_ns on the camera's clock, unwrapped,
        arrival_ns on its host's; and global_ms_NAME for each of `device_times`.
        """
        return array(self._inspection.frames(list(device_times)))

    def __repr__(self) -> str:
        return page_text(self._inspection.text)


class Diagnosis:
    """Whether the hardware sync of a recorded rig works: what `simbench diagnose` prints."""

    def __init__(self, diagnosis: _simbench.Diagnosis) -> None:
        self._diagnosis = diagnosis
        self._data: Dict[str, Any] = json.loads(diagnosis.json())

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as `simbench diagnose --format json` prints it."""
        return self._data

    @property
    def notes(self) -> List[str]:
        """What was left out, a line each."""
        return self._diagnosis.notes

    @property
    def verdict(self) -> str:
        """"works", "works_with_offset", "slips", "does_not_work" or "cannot_be_told"."""
        return str(self._data["verdict"]["status"])

    @property
    def reason(self) -> str:
        """Of the verdict, in words."""
        return str(self._data["verdict"]["reason"])

    @property
    def findings(self) -> List[Dict[str, str]]:
        """Faults and noteworthy facts: camera, stream, kind, text."""
        return list(self._data["findings"])

    @property
    def table(self) -> Any:
        """A row a stream of a camera."""
        return table(self._data["cameras"])

    def save_html(self, path: Path) -> None:
        """Writes the page of `simbench diagnose --html`."""
        with open(path, "w", encoding="utf-8") as file:
            command = ["simbench", "diagnose", *self._data["files"]]
            file.write(self._diagnosis.page(command))

    def __repr__(self) -> str:
        return page_text(self._diagnosis.text)

    def _repr_html_(self) -> str:
        return notebook_html(paragraphs(self._diagnosis.head()) + self._diagnosis.html())


def replay(
    recordings: Paths,
    *,
    pipelines: Optional[Sequence[str]] = None,
    progress: Optional[bool] = None,
) -> Result:
    """Scores a recording: a folder of `simbench record`, or files of real cameras, whose pipelines
    are device_time[+gathering]."""
    with Progress(progress, "capture") as shown:
        result = Result(
            _simbench.score_recording(_paths(recordings), list(pipelines or []), shown.callback),
            progress,
        )
    _warn(result.notes)
    return result


def inspect(recordings: Paths, *, progress: Optional[bool] = None) -> Inspection:
    """Says what recordings have: streams, frames, clocks, and every stamp."""
    with Progress(progress, "stamp") as shown:
        found = Inspection(_simbench.inspect_files(_paths(recordings), shown.callback))
    _warn(found.notes)
    return found


def diagnose(
    recordings: Paths,
    *,
    rate_hz: Optional[float] = None,
    one_host: bool = False,
    clock_logs: Sequence[str] = (),
    progress: Optional[bool] = None,
) -> Diagnosis:
    """Finds out whether the hardware sync of a recorded rig works. rate_hz: the trigger's; None: the
    rate of most cameras. one_host: one computer stamped all arrivals. clock_logs: logs of the
    hosts' clocks, "HOST=FILE" each, or a file alone."""
    with Progress(progress, "stamp") as shown:
        found = Diagnosis(
            _simbench.diagnose_files(
                _paths(recordings), rate_hz, one_host, list(clock_logs), shown.callback
            )
        )
    _warn(found.notes)
    return found
