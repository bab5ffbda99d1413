"""What commands write as files: recordings, timelines, figures, reports, matched frames."""

from __future__ import annotations

import json
import os
import re
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

from .algorithms import Pipeline
from .command import (
    Ended, Paths, archives_of, joined, paths_of, repeated, run_command, sets_of, words_of,
)  # fmt: skip
from .errors import Error, InputError
from .results import Path, Result, _whole, changes_of, use_python
from .tables import records, table, write_text


class Trace:
    """One run of one pipeline as a timeline: what `simbench trace` writes."""

    def __init__(self, ended: Ended, format: str) -> None:
        self._text = ended.output
        self._notes = ended.notes
        self._format = format

    @property
    def notes(self) -> List[str]:
        """What was left out, a line each."""
        return list(self._notes)

    @property
    def data(self) -> Dict[str, Any]:
        """Of the format "chrome": the trace; times in us as "ts"."""
        if self._format != "chrome":
            raise InputError("data: found a trace of the format csv, allowed: chrome")
        return dict(json.loads(self._text))

    @property
    def table(self) -> Any:
        """Of the format "csv": a row an event or a sample, with the columns of the file."""
        if self._format != "csv":
            raise InputError("table: found a trace of the format chrome, allowed: csv")
        return table(records(self._text))

    def text(self) -> str:
        """What `simbench trace` writes, for the Perfetto UI (chrome) or PlotJuggler (csv)."""
        return self._text

    def save(self, path: Path) -> None:
        """Writes it to a file."""
        write_text(path, self._text)


def trace(
    scenario: Path,
    pipeline: Union[str, Pipeline, None] = None,
    *,
    seed: int = 1,
    set: Optional[Mapping[str, Any]] = None,
    format: str = "chrome",
    from_ms: Optional[float] = None,
    to_ms: Optional[float] = None,
    max_events: int = 200_000,
    certify: bool = False,
    program: Union[str, Sequence[str]] = (),
    program_log: Optional[Path] = None,
    python: Union[Path, Sequence[Path]] = (),
    progress: Optional[bool] = None,
) -> Trace:
    """Runs one pipeline and returns the run as a timeline.

    scenario: a name or the path of a JSON file; set: changes of it. pipeline: None: yoon2021_both,
        else the first. seed: of the run.
    format: "chrome", for the Perfetto UI, or "csv", for PlotJuggler.
    from_ms, to_ms: only events that begin then, in ms of true time since the start of host
        synchronisation; max_events: how many at most.
    certify: with each set how far its frames were exposed apart at most, for sure.
    program, program_log, python: as for run().
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    use_python(python)
    names, changes = changes_of("trace", scenario, [pipeline] if pipeline else None, set)
    options = words_of(
        scenario=scenario, pipeline=names, seed=seed, set=changes, format=format, from_ms=from_ms,
        to_ms=to_ms, max_events=max_events, certify=bool(certify), program=repeated("program", program),
        program_log=program_log,
    )  # fmt: skip
    return Trace(run_command("trace", options, progress=progress), format)


def record(
    scenario: Path,
    output: Path,
    *,
    pipelines: Optional[Sequence[Union[str, Pipeline]]] = None,
    seed: int = 1,
    repeats: int = 1,
    set: Optional[Mapping[str, Any]] = None,
    program: Union[str, Sequence[str]] = (),
    program_log: Optional[Path] = None,
    python: Union[Path, Sequence[Path]] = (),
    backend: str = "sim",
    rig: Optional[Path] = None,
    key_file: Optional[Path] = None,
    collect: Optional[str] = None,
    progress: Optional[bool] = None,
) -> str:
    """Records captures of a scenario into a new folder, `output`, for replay(), inspect() and fit(),
    and returns its path.

    scenario: a name or the path of a JSON file; set: changes of it. pipelines: as for run(); None:
        all. seed: the first; repeats: captures of each pipeline.
    program, program_log, python: as for run().
    backend, rig, key_file: "hardware" captures on the rig of this rig file, whose hosts run
        `simbench node`; collect: in place of a capture, fetch what its nodes have of this session.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    use_python(python)
    names, changes = changes_of("record", scenario, pipelines, set)
    options = words_of(
        scenario=scenario, pipelines=names, seed=seed, set=changes,
        repeats=_whole("repeats", repeats, 1, 1_000_000), program=repeated("program", program),
        program_log=program_log, backend=backend, rig=rig, key_file=key_file, collect=collect,
        output=output,
    )  # fmt: skip
    run_command("record", options, progress=progress, unit="capture")
    return os.fspath(output)


def figure(
    name: str,
    output: Path,
    archive: Union[Result, Paths, None] = None,
    *,
    scenario: Optional[Path] = None,
    set: Optional[Mapping[str, Any]] = None,
    pipelines: Optional[Sequence[str]] = None,
    seed: Optional[int] = None,
    seeds: int = 32,
    topics: Sequence[str] = (),
    columns: Optional[str] = None,
    progress: Optional[bool] = None,
) -> str:
    """Draws one figure to a file and returns its path.

    name: of listing("figures"), or of the paper as "fig8". output: a file whose name ends in .svg,
        .pdf (both by gnuplot) or .csv.
    archive: a Result, the folder of an archive, or a recording (a folder, or files; topics and
        columns as for inspect()). In its place scenario, with changes by set.
    pipelines: only these. seed: of a figure of one seed; seeds: of one over a scenario's seeds.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    options = words_of(
        scenario=scenario, set=sets_of(set), pipelines=joined("pipelines", pipelines), seed=seed,
        seeds=_whole("seeds", seeds, 1, 1_000_000), topics=joined("topics", topics),
        columns=columns, output=output,
    )  # fmt: skip
    with archives_of("archive", () if archive is None else archive, may_be_none=True) as paths:
        run_command("figure", options, [name, *paths], progress=progress)
    return os.fspath(output)


def report(
    archives: Union[Result, Path, Sequence[Union[Result, Path]]],
    output: Optional[Path] = None,
    *,
    seeds_in_detail: Optional[int] = None,
    budget_seeds: Optional[int] = None,
    pipelines: Sequence[str] = (),
    progress: Optional[bool] = None,
) -> str:
    """Makes one HTML file of results, with tables and figures, and returns its path.

    archives: results or folders of archives. output: the file; None, of one folder: beside it.
    seeds_in_detail: how many seeds are shown with stamps, clocks and single pulses.
    budget_seeds: of the error budgets (136 runs for each seed and pipeline); 0: none.
    pipelines: only these in detail; the tables have all.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    if output is None and any(isinstance(each, Result) for each in
                              (archives if isinstance(archives, Sequence) else [archives])):
        raise InputError("output: found none for a Result, allowed: a name such as both.html")
    options = words_of(
        output=output, seeds_in_detail=seeds_in_detail, budget_seeds=budget_seeds,
        pipelines=joined("pipelines", pipelines),
    )  # fmt: skip
    with archives_of("archives", archives) as paths:
        ended = run_command("report", options, paths, progress=progress)
    written = [re.match(r"report written to (.*) \([0-9.]+ MB\)$", note) for note in ended.notes]
    for found in filter(None, written):
        return found[1]
    raise Error("report: the command names no file")


def export(
    inputs: Paths,
    output: Optional[Path] = None,
    *,
    device_time: str = "regression_30",
    gathering: str = "yoon2021",
    stream: Optional[str] = None,
    complete: bool = False,
    stamps: Sequence[str] = (),
    topics: Sequence[str] = (),
    columns: Optional[str] = None,
    progress: Optional[bool] = None,
) -> Any:
    """Says which frames belong together: a row a frame, with set, camera, stream, file, topic, number
    of the message in its topic, counter, and sensor_ns, arrival_ns and stamp_ns in ns, exactly.
    Returns a table; with `output` it writes the CSV to this file, too.

    inputs: files of real cameras or a recording folder; topics and columns as for inspect().
    device_time: stamps the frames; gathering: finds the sets; stream: of this kind of stream.
    complete: only sets in which no camera is missing.
    stamps: in place of sets every frame, with its global stamps by these device_times.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    options = words_of(
        device_time=device_time, gathering=gathering, stream=stream, complete=bool(complete),
        stamps=joined("stamps", stamps), topics=joined("topics", topics), columns=columns,
    )  # fmt: skip
    text = run_command("export", options, paths_of("inputs", inputs), progress=progress,
                       unit="byte").output
    if output is not None:
        write_text(output, text)
    return table(records(text))


def convert_ibl(file: Path) -> str:
    """A recording of an IBL camera rig (*.timestamps.ssv or *.frameData.bin, the path `file`) as the
    text of a CSV recording, which replay() and others read from a file."""
    return run_command("convert-ibl", [], [os.fspath(file)]).output
