"""Runs: simulated now, read from an archive, or scored from a recording folder."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import warnings
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from . import _simbench
from .algorithms import Pipeline
from .errors import InputError, OutputError
from .progress import Progress
from .tables import array, needed, notebook_html, page_text, records, table, write_text

Path = Union[str, "os.PathLike[str]"]
_MOST_SEEDS = 1_000_000
_MOST_JOBS = 4096
_MOST_PLOTTED = 24


def _warn(notes: Sequence[str], depth: int = 1) -> None:
    """Of the caller of whoever is `depth` calls above."""
    for note in notes:
        warnings.warn(note, stacklevel=2 + depth)


def _whole(name: str, value: Any, low: int, high: int) -> int:
    if isinstance(value, bool) or not hasattr(value, "__index__") or not low <= value <= high:
        raise InputError(
            f"{name}: found {value!r}, allowed: a whole number from {low} to {high}"
        )
    return int(value)


def request_of(
    function: str,
    scenario: Path,
    pipelines: Optional[Sequence[Union[str, Pipeline]]],
    seeds: int,
    first_seed: int,
    sets: Optional[Mapping[str, Any]],
    jobs: int,
) -> _simbench.RunRequest:
    """What the libraries are asked for, checked. `function`: who is called, for the manifest."""
    if isinstance(pipelines, str):
        raise InputError(f"pipelines: found the text {pipelines!r}, allowed: a list of names")
    request = _simbench.RunRequest()
    request.scenario = os.fspath(scenario)
    request.pipelines = [pipeline.name if isinstance(pipeline, Pipeline) else pipeline
                         for pipeline in pipelines or []]
    request.sets = [(pointer, json.dumps(value)) for pointer, value in (sets or {}).items()]
    request.sets += [
        ("/pipelines/-", json.dumps(_stages(pipeline, request)))
        for pipeline in pipelines or []
        if isinstance(pipeline, Pipeline)
    ]
    request.seeds = _whole("seeds", seeds, 1, _MOST_SEEDS)
    request.first_seed = _whole("first_seed", first_seed, 0, 2**53)
    request.jobs = _whole("jobs", jobs, 0, _MOST_JOBS)
    request.command = ["python", f"simbench.{function}", request.scenario]
    request.command += [f"--pipelines={','.join(request.pipelines)}"] if pipelines else []
    request.command += [f"--seeds={seeds}", f"--first-seed={first_seed}"]
    request.command += [f"--set={pointer}={value}" for pointer, value in request.sets]
    return request


def changes_of(
    function: str,
    scenario: Optional[Path],
    pipelines: Optional[Sequence[Union[str, Pipeline]]],
    sets: Optional[Mapping[str, Any]],
) -> Tuple[Optional[str], List[str]]:
    """The values of --pipelines and --set of a command line."""
    if scenario is None:  # a study names its own
        if any(isinstance(pipeline, Pipeline) for pipeline in pipelines or []):
            raise InputError("pipelines: found a Pipeline and no scenario, allowed: names")
        scenario = ""
    request = request_of(function, scenario, pipelines, 1, 1, sets, 0)
    return ",".join(request.pipelines) or None, [f"{at}={value}" for at, value in request.sets]


def use_python(files: Union[Path, Sequence[Path]]) -> None:
    """Registers the algorithms of these files, as --python does."""
    from .__main__ import import_algorithms

    for file in [files] if isinstance(files, (str, os.PathLike)) else files:
        try:
            import_algorithms(os.fspath(file))
        except ImportError as error:
            raise InputError(str(error).replace("--python", "python:", 1)) from error.__cause__


def _add_programs(
    request: _simbench.RunRequest, programs: Union[str, Sequence[str]], log: Optional[Path]
) -> None:
    """Pipelines of real programs, as --program and --program-log."""
    _simbench.keep_program_files(os.fspath(log) if log is not None else "")
    named = [programs] if isinstance(programs, str) else list(programs)
    if not named:
        return
    sets, names, notes = _simbench.program_pipelines(
        request.scenario, request.sets, named, request.pipelines
    )
    request.sets = [*request.sets, *sets]
    request.pipelines = names
    _warn(notes, 2)


def _stages(pipeline: Pipeline, request: _simbench.RunRequest) -> Dict[str, Any]:
    """A pipeline by its stages, as scenarios have it: those that it names, the others of its base."""
    known = _simbench.pipelines_of(request.scenario, request.sets)
    base = pipeline.base or known[0]["name"]
    for stages in known:
        if stages["name"] != base:
            continue
        for stage, may_be_absent in _simbench.stages().items():
            algorithm = getattr(pipeline, stage)
            if algorithm:
                stages[stage] = algorithm
            elif algorithm == "" and may_be_absent:
                stages.pop(stage, None)
        return {**stages, "name": pipeline.name}
    names = ", ".join(each["name"] for each in known)
    raise InputError(f"pipeline {pipeline.name}: base: found {base!r}, allowed: {names}")


class Result:
    """The results of all pipelines over all seeds: what `simbench run` prints and writes."""

    def __init__(
        self,
        run: _simbench.Run,
        progress: Optional[bool] = None,
        archive: Optional[str] = None,
        kept: Any = None,
    ) -> None:
        """archive: where it was read. kept: what owns that folder, if it is the Result's own."""
        self._run = run
        self._progress = progress
        self._archive = archive
        self._kept = kept
        self._html: Optional[str] = None

    @property
    def scenario(self) -> str:
        """The scenario's name."""
        return self._run.scenario

    @property
    def notes(self) -> List[str]:
        """What is doubtful about the results, a line each; mostly empty."""
        return self._run.notes

    @property
    def table(self) -> Any:
        """A row a pipeline, with the columns of `simbench run --format csv`: the median of each
        metric and of some the 5 and 95 % quantiles, the published values.

        A pandas DataFrame; without pandas a list of dicts.
        """
        return table(records(self._run.csv()))

    @property
    def seeds(self) -> Any:
        """Every value: scenario, pipeline, seed, metric, unit, value. As `table`."""
        return table(records(self._run.tidy_csv()))

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as results.json has it."""
        return dict(json.loads(self._run.json()))

    @property
    def answer(self) -> str:
        """The answer in one paragraph, as `simbench run --quiet` prints it."""
        return self.text(detail="answer")

    def text(self, format: str = "table", detail: str = "screen") -> str:
        """What `simbench run` prints. `format`: table, markdown, latex, csv, tidy or json; `detail`
        of a table: answer, screen or all."""
        for name, found, allowed in (
            ("format", format, ("table", "markdown", "latex", "csv", "tidy", "json")),
            ("detail", detail, ("answer", "screen", "all")),
        ):
            if found not in allowed:
                raise InputError(f"{name}: found {found!r}, allowed: {', '.join(allowed)}")
        with Progress(self._progress, "run") as shown:
            return self._run.text(format, detail, shown.callback)

    def frames(self, pipeline: str, seed: Optional[int] = None) -> Any:
        """Every frame of one run, of this pipeline and seed (None: the first): a structured NumPy
        array of the shape (frames,), read-only, in the memory of the libraries.

        Fields: camera, host, counter, pulse (-1: none or unknown), evaluated, in_warm_up; sensor_ms
        and frame_ms on the device's clock; backend_ms and arrival_ms on the host's; global_ms, the
        pipeline's stamp; reference_ms, what it should be, and error_ms, the difference;
        exposure_start_ms and exposure_end_ms in true time. Hosts' times count from one zero. NaN:
        it does not exist.

        The run is repeated (some 10 ms for 18 cameras), so a Result holds no frames. At most 18
        cameras are kept; a warning says so.
        """
        if seed is None:
            seed = self._run.first_seed
        with Progress(self._progress, "run") as shown:
            rows, kept, cameras = self._run.frames(pipeline, seed, shown.callback)
        if kept < cameras:
            _warn([f"frames of the first {kept} of {cameras} cameras"])
        return array(rows)

    def plot(self, ax: Any = None) -> Any:
        """The first figure of the report: each pipeline's median, band and published value on a
        logarithmic axis. Returns matplotlib's axes; `ax`: where to draw."""
        pyplot = needed("matplotlib.pyplot", "plot()")
        rows = self._run.overview()
        if not rows:
            raise InputError(f"{self.scenario}: found no pipeline with a value above 0 to draw")
        hidden = len(rows) - _MOST_PLOTTED
        rows = rows[:_MOST_PLOTTED]
        if ax is None:
            _, ax = pyplot.subplots(figsize=(8, 1 + 0.32 * len(rows)), layout="constrained")
        for place, row in enumerate(rows):
            colour = {"best": "tab:green", "": "tab:blue"}.get(row["word"], "tab:gray")
            ax.plot([row["p05_ms"], row["p95_ms"]], [place, place], color=colour, lw=4, alpha=0.4)
            ax.plot(row["median_ms"], place, "o", color=colour)
            if row["published_ms"] is not None:
                ax.plot(row["published_ms"], place, "D", color="black", fillstyle="none")
        names = [f"{row['pipeline']} ({row['word']})" if row["word"] else row["pipeline"] for row in rows]
        ax.set_yticks(range(len(rows)), names)
        ax.set_ylim(len(rows) - 0.4, -0.6)
        ax.set_xscale("log")
        ax.set_xlabel(f"{self._run.ranked_name}, ms: median and 5-95 % of {self._run.seed_count} seeds")
        more = f" (the first {_MOST_PLOTTED} of {_MOST_PLOTTED + hidden})" if hidden > 0 else ""
        published = ", diamonds: published" if any(r["published_ms"] is not None for r in rows) else ""
        changed = " (changed)" if self.data.get("changed") else ""
        ax.set_title(f"{self.scenario}{changed}{more}{published}", fontsize="medium")
        ax.grid(True, axis="x", alpha=0.3)
        return ax

    def save(self, folder: Path) -> None:
        """Writes the archive that `simbench run --output` writes."""
        if self._kept is None or self._archive is None:
            self._run.save(os.fspath(folder))
            return
        try:
            shutil.copytree(self._archive, folder)
        except OSError as error:
            raise OutputError(f"{os.fspath(folder)}: {error.strerror or error}") from error

    def __repr__(self) -> str:
        return page_text(self.text)

    def _repr_html_(self) -> str:
        if self._html is None:
            with Progress(self._progress, "run") as shown:
                self._html = notebook_html(self._run.html(shown.callback))
        return self._html


class Comparison:
    """Two results, or pipelines of one, compared seed by seed: what `simbench compare` prints."""

    def __init__(self, comparison: _simbench.Comparison, command: List[str]) -> None:
        self._comparison = comparison
        self._command = command

    @property
    def table(self) -> Any:
        """A row a pipeline and metric, with its verdict. A pandas DataFrame; else a list of dicts."""
        return table(records(self._comparison.csv()))

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as `simbench compare --format json` prints it."""
        return dict(json.loads(self._comparison.json()))

    def save_html(self, path: Path) -> None:
        """Writes the page of `simbench compare --html`."""
        write_text(path, self._comparison.page(self._command))

    def __repr__(self) -> str:
        return page_text(self._comparison.text)

    def _repr_html_(self) -> str:
        return notebook_html(self._comparison.html())


def run(
    scenario: Path,
    pipelines: Optional[Sequence[Union[str, Pipeline]]] = None,
    seeds: Optional[int] = None,
    *,
    set: Optional[Mapping[str, Any]] = None,
    first_seed: int = 1,
    jobs: int = 0,
    rank_by: Optional[str] = None,
    no_levers: bool = False,
    certify: bool = False,
    program: Union[str, Sequence[str]] = (),
    program_log: Optional[Path] = None,
    python: Union[Path, Sequence[Path]] = (),
    backend: str = "sim",
    rig: Optional[Path] = None,
    key_file: Optional[Path] = None,
    keep_pulses: bool = True,
    progress: Optional[bool] = None,
) -> Result:
    """Runs pipelines of a scenario over many seeds, as `simbench run` does.

    scenario: a name (list_scenarios()) or the path of a JSON file.
    pipelines: names of the scenario's, "host_sync[+capture_alignment]+device_time+gathering", or
        simbench.pipeline(); None: all.
    seeds: how many; None: 32, on a real rig 1. first_seed: the first.
    set: changes of the scenario, {"/trigger/rate_hz": 30}.
    jobs: threads; 0: one for every core.
    rank_by: rank the pipelines by this metric.
    no_levers: the answer does not look for what would improve the best pipeline.
    certify: rows have certified_ms: no two frames of 95 % of the sets were exposed further apart, for
        sure (certify() says what limits it).
    program: also pipelines of real programs, ["mine=examples/cristian.json"], or names of built-in
        ones; program_log: a folder for what they print.
    python: files with algorithms, which are imported first.
    backend, rig, key_file: "hardware" captures on the rig of this rig file, whose hosts run
        `simbench node`, `seeds` times each pipeline.
    keep_pulses: keep what Result.save() needs, 24 bytes for each pulse of each run.
    progress: show it; None: where tqdm is installed and somebody looks.

    Raises InputError, KeyboardInterrupt at Ctrl-C. Doubts about the scenario become warnings.
    """
    use_python(python)
    if seeds is None:
        seeds = 1 if backend == "hardware" else 32
    request = request_of("run", scenario, pipelines, seeds, first_seed, set, jobs)
    request.certify = bool(certify)
    if backend != "sim" or rig is not None or key_file is not None:
        return _run_on_rig(request, backend, rig, key_file, progress)
    _add_programs(request, program, program_log)
    request.keep_pulses = bool(keep_pulses)
    request.rank_by = rank_by or ""
    request.no_levers = bool(no_levers)
    with Progress(progress, "run") as shown:
        result = Result(_simbench.simulate(request, shown.callback), progress)
    _warn(result.notes)
    return result


def _run_on_rig(
    request: _simbench.RunRequest,
    backend: str,
    rig: Optional[Path],
    key_file: Optional[Path],
    progress: Optional[bool],
) -> Result:
    """Captures on a real rig, by the command, whose archive is read."""
    from .command import run_command, words_of

    folder = tempfile.TemporaryDirectory(prefix="simbench_")
    archive = os.path.join(folder.name, "rig")
    options = words_of(
        scenario=request.scenario, pipelines=",".join(request.pipelines) or None,
        set=[f"{pointer}={value}" for pointer, value in request.sets], seeds=request.seeds,
        first_seed=request.first_seed, certify=request.certify, backend=backend, rig=rig,
        key_file=key_file, output=archive,
    )  # fmt: skip
    run_command("run", options, progress=progress)
    return Result(_simbench.load_archive(archive), progress, archive, folder)


def load(folder: Path, *, progress: Optional[bool] = None) -> Result:
    """Reads the archive of a run, `folder`: one of `simbench run --output`, or a results.json.
    progress: show that of the Result's work; None: where tqdm is installed and somebody looks."""
    path = os.fspath(folder)
    result = Result(_simbench.load_archive(path), progress, path)
    if result._run.is_clock_run:
        raise InputError(
            f"{path}: found an archive of `simbench clocks`, allowed: one of `simbench run`"
        )
    return result


def _as_run(of: Union[Result, Path]) -> _simbench.Run:
    return of._run if isinstance(of, Result) else _simbench.load_archive(os.fspath(of))


def compare(
    a: Union[Result, Path],
    b: Union[Result, Path, None] = None,
    *,
    with_baseline: Optional[str] = None,
    pipelines: Optional[Sequence[str]] = None,
    smallest_effect: float = 0.05,
    by_index: bool = False,
    different_scenarios: bool = False,
    html: Optional[Path] = None,
    baseline: Optional[str] = None,
) -> Comparison:
    """Compares b with a, pipeline by pipeline; or, with a alone, every pipeline with `with_baseline`,
    or the second of two `pipelines` with the first.

    a, b: results or folders of archives.
    smallest_effect: the smallest difference that matters, as a share of a's mean (the command takes
        percent).
    by_index: pair the n-th seed of a with the n-th of b.
    different_scenarios: the worlds may differ.
    html: a file for the page, as Comparison.save_html() writes it.
    baseline: another name of with_baseline.
    """
    with_baseline = with_baseline if with_baseline is not None else baseline
    options = _simbench.ComparisonOptions()
    options.smallest_effect = smallest_effect
    options.by_index = by_index
    options.different_scenarios = different_scenarios
    names = list(pipelines or [])
    if b is not None:
        if with_baseline is not None:
            raise InputError("with_baseline: found two results, allowed: one, whose pipelines are compared")
        options.pipelines = names
        found = _simbench.compare_runs(_as_run(a), _as_run(b), options)
    elif with_baseline is not None and not names:
        found = _simbench.compare_baseline(_as_run(a), with_baseline, options)
    elif with_baseline is None and len(names) == 2:
        found = _simbench.compare_two(_as_run(a), names[0], names[1], options)
    else:
        raise InputError(
            "found one result, allowed with it: either two pipelines or with_baseline; or a second result"
        )
    comparison = Comparison(found, _compare_command([a, b], with_baseline, names))
    if html is not None:
        comparison.save_html(html)
    return comparison


def _compare_command(
    of: Sequence[Union[Result, Path, None]], with_baseline: Optional[str], pipelines: Sequence[str]
) -> List[str]:
    """The command that compares the same; RESULT stands for one that is in no file."""
    named = ["RESULT" if isinstance(each, Result) else os.fspath(each) for each in of if each is not None]
    words = ["simbench", "compare", *named]
    if with_baseline is not None:
        words += ["--with-baseline", with_baseline]
    return words + (["--pipelines", ",".join(pipelines)] if pipelines else [])
