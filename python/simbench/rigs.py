"""Recordings of real cameras: scores, inspection and diagnosis."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Optional, Sequence, Union

from . import _simbench
from .command import Paths, joined, paths_of, repeated, run_command, words_of
from .errors import InputError
from .progress import Progress
from .results import Path, Result, _warn
from .tables import array, notebook_html, page_text, paragraphs, table, write_text

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
        return dict(json.loads(self._inspection.json()))

    @property
    def table(self) -> Any:
        """A row a stream: camera, frames, rate, gaps, periods and delays with their units in the
        names."""
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
        """Why, in words."""
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
        command = ["simbench", "diagnose", *self._data["files"]]
        write_text(path, self._diagnosis.page(command))

    def __repr__(self) -> str:
        return page_text(self._diagnosis.text)

    def _repr_html_(self) -> str:
        return notebook_html(paragraphs(self._diagnosis.head()) + self._diagnosis.html())


def _names(name: str, of: Optional[Sequence[str]]) -> List[str]:
    if isinstance(of, str):
        raise InputError(f"{name}: found the text {of!r}, allowed: a list of names")
    return list(of or [])


def replay(
    recordings: Paths,
    *,
    pipelines: Optional[Sequence[str]] = None,
    topics: Sequence[str] = (),
    columns: Optional[str] = None,
    stream: Optional[str] = None,
    genlock: bool = False,
    certify: bool = False,
    rank_by: Optional[str] = None,
    progress: Optional[bool] = None,
) -> Result:
    """Scores a recording, as `simbench replay` does.

    recordings: a folder of record(), or files of real cameras; topics (of bags) and columns (of CSV)
        as for inspect().
    pipelines: of a folder, some of its own; of files, device_time[+gathering]; None: all.
    stream: of files, which kind; None: the one that most cameras have.
    genlock: of files: one trigger pulse started all cameras, so that the order of frames tells which
        belong together.
    certify: rows have certified_ms: no two frames of 95 % of the sets were exposed further apart, for
        sure (certify() says what limits it).
    rank_by: rank the pipelines by this metric.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    paths = paths_of("recordings", recordings)
    names = _names("pipelines", pipelines)
    request = _simbench.RecordingToScore()
    request.inputs = paths
    request.topics = _names("topics", topics)
    request.columns = columns or ""
    request.pipelines = names
    request.stream = stream or ""
    request.genlock = bool(genlock)
    request.certify = bool(certify)
    request.rank_by = rank_by or ""
    request.command = ["python", "simbench.replay", *paths]
    with Progress(progress, "capture") as shown:
        result = Result(_simbench.score_recording(request, shown.callback), progress)
    _warn(result.notes)
    return result


def inspect(
    recordings: Paths,
    *,
    device_times: Sequence[str] = (),
    topics: Sequence[str] = (),
    columns: Optional[str] = None,
    progress: Optional[bool] = None,
) -> Inspection:
    """Says what recordings have: streams, frames, clocks, and every stamp.

    recordings: a recording folder; or bags (RealSense, ROS 1, ROS 2), CSV files, videos, and folders
        of them.
    device_times: also the jitter, residual and drift of the stamps by these.
    topics: of bags only these; none: those that look like a camera's.
    columns: of CSV files, "sensor=t_camera:us,arrival=t_host:s" (docs/files.md).
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    paths = paths_of("recordings", recordings)
    with Progress(progress, "byte") as shown:
        found = Inspection(
            _simbench.inspect_files(
                paths, _names("topics", topics), columns or "",
                _names("device_times", device_times), shown.callback,
            )
        )  # fmt: skip
    _warn(found.notes)
    return found


def diagnose(
    recordings: Paths,
    *,
    rate_hz: Optional[float] = None,
    one_host: bool = False,
    clock_log: Union[str, Sequence[str]] = (),
    topics: Sequence[str] = (),
    columns: Optional[str] = None,
    html: Optional[Path] = None,
    pack: Optional[Path] = None,
    clock_logs: Sequence[str] = (),
    progress: Optional[bool] = None,
) -> Diagnosis:
    """Finds out whether the hardware sync of a recorded rig works.

    recordings, topics, columns: as for inspect(); several files are one rig.
    rate_hz: the trigger's; None: the rate of most cameras.
    one_host: one computer stamped all arrivals.
    clock_log: logs of the hosts' clocks, "HOST=FILE" each, or a file alone; clock_logs: the same.
    html: a file for the page, as Diagnosis.save_html() writes it.
    pack: a new folder for the stamps alone, without images and names, for somebody else to look at;
        what is called what are warnings.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    paths = paths_of("recordings", recordings)
    logs = [*repeated("clock_log", clock_log), *_names("clock_logs", clock_logs)]
    with Progress(progress, "byte") as shown:
        found = Diagnosis(
            _simbench.diagnose_files(
                paths, _names("topics", topics), columns or "", rate_hz, bool(one_host), logs,
                shown.callback,
            )
        )  # fmt: skip
    _warn(found.notes)
    if html is not None:
        found.save_html(html)
    if pack is not None:
        options = words_of(topics=joined("topics", topics), columns=columns, clock_log=logs,
                           pack=pack)
        _warn(run_command("diagnose", options, paths, formats=["json"]).notes)
    return found
