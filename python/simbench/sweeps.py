"""Sweeps: how each pipeline responds to parameters of a scenario."""

from __future__ import annotations

import json
import math
import os
import tempfile
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from .algorithms import Pipeline
from .command import Ended, Output, repeated, run_command, words_of
from .errors import InputError, OutputError
from .results import Path, _whole, changes_of, use_python
from .tables import needed, records, table

#: Values of a swept parameter: "0:1:0.1", or a sequence of numbers or words.
Values = Union[str, Sequence[Any]]

_UNITS = ("ms", "s", "us", "ns", "hz", "ppm", "ppb")
_LOCK = "lock"
_MOST_CURVES = 24


class Sweep(Output):
    """What `simbench sweep` finds: every metric at each point, for each pipeline and seed."""

    formats = ("table", "markdown", "html")

    def __init__(self, ended: Ended, files: Mapping[str, bytes]) -> None:
        super().__init__(ended, json.loads(files["answer.json"]))
        self._files = dict(files)
        self._manifest: Dict[str, Any] = json.loads(files["manifest.json"])

    @property
    def scenario(self) -> str:
        """The scenario's name."""
        return str(self._data["scenario"])

    @property
    def axes(self) -> List[Dict[str, List[Any]]]:
        """What is varied: for each axis its pointers and their values; several pointers of one axis
        vary together."""
        return [dict(axis) for axis in self._manifest["axes"]]

    @property
    def data(self) -> Dict[str, Any]:
        """answer.json of the folder: the answer, the scenario, the metric that ranks."""
        return self._data

    @property
    def table(self) -> Any:
        """sweep.csv, a row for each point, pipeline and seed: the swept values under their pointers,
        pipeline, seed, and the metrics with their units in the names. NaN: no such value."""
        return table(self._records("sweep.csv"))

    @property
    def hosts(self) -> Any:
        """hosts.csv: the same with a row for each host (0: the master) and its mean clock error in
        ms as error_ms."""
        return table(self._records("hosts.csv"))

    @property
    def metrics(self) -> List[str]:
        """The columns of `table` that are metrics."""
        columns = self._files["sweep.csv"].decode("utf-8").split("\n", 1)[0].strip().split(",")
        return [name for name in columns[columns.index("seed") + 1 :] if name != "changed"]

    @property
    def dataset(self) -> Any:
        """An xarray.Dataset with a variable for each metric, of the shape (axis, ..., pipeline,
        seed). An axis has the name and the values of its first pointer; the others that vary with it
        are coordinates along it. NaN: no such value, or a point that is left out."""
        return self.to_xarray()

    def to_xarray(self) -> Any:
        """See `dataset`. Raises MissingPackage without xarray."""
        xarray = needed("xarray", "to_xarray()")
        numpy = needed("numpy", "to_xarray()")
        rows = self._records("sweep.csv")
        axes = self.axes
        places = [_places(axis) for axis in axes]
        pipelines = [str(name) for name in self._manifest["pipelines"]]
        seeds = self._seeds()
        names = [next(iter(axis)) for axis in axes]
        shape = (*(len(place) for place in places), len(pipelines), len(seeds))
        values = {name: numpy.full(shape, math.nan) for name in self.metrics}
        for row in rows:
            at = tuple(place[_key(row, axis)] for place, axis in zip(places, axes))
            at += (pipelines.index(row["pipeline"]), row["seed"] - seeds[0])
            for name, array in values.items():
                if isinstance(row[name], (int, float)):
                    array[at] = row[name]
        dims = (*names, "pipeline", "seed")
        coordinates: Dict[str, Any] = {"pipeline": pipelines, "seed": list(seeds)}
        for name, axis in zip(names, axes):
            for pointer, steps in axis.items():
                coordinates[pointer] = (name, _coordinate(steps))
        return xarray.Dataset(
            {name: (dims, array, _unit(name)) for name, array in values.items()},
            coords=coordinates,
            attrs={"scenario": self.scenario, "title": f"simbench sweep of {self.scenario}"},
        )

    def plot(self, metric: Optional[str] = None, ax: Any = None) -> Any:
        """The response of each pipeline: the median over the seeds and the 5 to 95 % band, along the
        first axis, with a curve for each step of the others. `metric`: one of `metrics`; None: that
        which ranks. Returns matplotlib's axes; `ax`: where to draw."""
        pyplot = needed("matplotlib.pyplot", "plot()")
        numpy = needed("numpy", "plot()")
        shown = metric or str(self._data["ranked_by"])
        if shown not in self.metrics:
            raise InputError(
                f"metric: found {shown!r}, allowed: {', '.join(self.metrics)}"
            )
        axis = self.axes[0]
        name, steps = next(iter(axis.items()))
        x = list(steps) if all(_is_number(step) for step in steps) else list(range(len(steps)))
        curves = self._curves(shown)
        if ax is None:
            _, ax = pyplot.subplots(figsize=(8, 4.5), layout="constrained")
        for label, seeds_at in list(curves.items())[:_MOST_CURVES]:
            band = [numpy.nanquantile(at, (0.05, 0.5, 0.95)) if at else [math.nan] * 3
                    for at in seeds_at]
            low, median, high = zip(*band)
            (line,) = ax.plot(x, median, "o-", label=label)
            ax.fill_between(x, low, high, color=line.get_color(), alpha=0.2, lw=0)
        if x != list(steps):
            ax.set_xticks(x, [str(step) for step in steps])
        drawn = [at for seeds_at in curves.values() for values in seeds_at for at in values]
        if drawn and min(drawn) > 0:
            ax.set_yscale("log")
        ax.set_xlabel(" and ".join(axis))
        ax.set_ylabel(f"{shown}: median and 5-95 % of {len(self._seeds())} seeds")
        ax.set_title(self.scenario, fontsize="medium")
        ax.grid(True, alpha=0.3)
        ax.legend(fontsize="small")
        return ax

    def save(self, folder: Path) -> None:
        """Writes the folder that `simbench sweep --output` writes; the same sweep goes on in it."""
        path = os.fspath(folder)
        try:
            os.makedirs(path)
            for name, content in self._files.items():
                with open(os.path.join(path, name), "wb") as file:
                    file.write(content)
        except OSError as error:
            raise OutputError(f"{path}: {error.strerror}") from error

    def _seeds(self) -> range:
        seeds = self._manifest["seeds"]
        return range(seeds["first"], seeds["first"] + seeds["count"])

    def _records(self, name: str) -> List[Dict[str, Any]]:
        return records(self._files[name].decode("utf-8"))

    def _curves(self, metric: str) -> Dict[str, List[List[float]]]:
        """By pipeline and steps of the other axes: for each step of the first, the seeds' values."""
        first, others = self.axes[0], self.axes[1:]
        places = _places(first)
        curves: Dict[str, List[List[float]]] = {}
        for row in self._records("sweep.csv"):
            steps = [f"{pointer}={row[pointer]}" for axis in others for pointer in axis]
            label = ", ".join([row["pipeline"], *steps])
            curve = curves.setdefault(label, [[] for _ in places])
            if isinstance(row[metric], (int, float)) and not math.isnan(row[metric]):
                curve[places[_key(row, first)]].append(row[metric])
        return curves


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _same(value: Any) -> Any:
    """A value of the manifest or of a CSV cell, comparable with the other."""
    if _is_number(value):
        return float(value)
    return str(value).lower() if isinstance(value, bool) else str(value)


def _key(row: Mapping[str, Any], axis: Mapping[str, Sequence[Any]]) -> Tuple[Any, ...]:
    return tuple(_same(row[pointer]) for pointer in axis)


def _places(axis: Mapping[str, Sequence[Any]]) -> Dict[Tuple[Any, ...], int]:
    """The place of each step of an axis."""
    return {tuple(_same(value) for value in step): place
            for place, step in enumerate(zip(*axis.values()))}


def _coordinate(steps: Sequence[Any]) -> List[Any]:
    return list(steps) if all(_is_number(step) for step in steps) else [_same(s) for s in steps]


def _unit(metric: str) -> Dict[str, str]:
    unit = metric.rsplit("_", 1)[-1]
    return {"units": unit} if unit in _UNITS else {}


def _axis_words(sweep: Union[str, Sequence[str], Mapping[str, Values], None]) -> List[str]:
    """The values of --sweep."""
    if not isinstance(sweep, Mapping):
        return repeated("sweep", sweep)
    words = []
    for pointer, values in sweep.items():
        if not isinstance(values, str):
            steps = [value if isinstance(value, str) else json.dumps(_plain(value))
                     for value in values]
            if not steps:
                raise InputError(f"sweep: found no value of {pointer}, allowed: one or more")
            values = ",".join(steps)
        words.append(f"{pointer}={values}")
    return words


def _plain(value: Any) -> Any:
    """A number of NumPy as one of Python."""
    return value.item() if hasattr(value, "item") else value


def sweep(
    scenario: Optional[Path] = None,
    sweep: Union[str, Sequence[str], Mapping[str, Values], None] = None,
    pipelines: Optional[Sequence[Union[str, Pipeline]]] = None,
    seeds: Optional[int] = None,
    *,
    study: Optional[str] = None,
    clocks: bool = False,
    duration_s: Optional[int] = None,
    from_s: Optional[int] = None,
    set: Optional[Mapping[str, Any]] = None,
    first_seed: int = 1,
    rank_by: Optional[str] = None,
    python: Union[Path, Sequence[Path]] = (),
    jobs: int = 0,
    output: Optional[Path] = None,
    restart: bool = False,
    progress: Optional[bool] = None,
) -> Sweep:
    """Varies parameters of a scenario and says how each pipeline responds, as `simbench sweep` does.

    scenario: a name (list_scenarios()) or the path of a JSON file.
    sweep: what to vary, {"/trigger/rate_hz": [15, 30], "/usb/delivery_jitter_transfers": "0:1:0.1"}
        (start:stop:step, the stop included); every combination is a point. Or the command's words:
        "/hosts/count=2:6:2+/cameras/count=6:18:6" joins parameters that vary together.
    pipelines: as for run(); None: all. seeds: at each point; None: 32, or the study's.
    study: a ready-made sweep in place of scenario and sweep (listing("studies")).
    clocks: the hosts' clocks alone, for duration_s seconds (None: 36000), counted from from_s on
        (None: 300), in place of captures.
    set: changes of the scenario at all points. first_seed: the first seed. rank_by: a metric.
    python: files with algorithms. jobs: threads; 0: one for every core.
    output: the folder of the sweep, in which an unfinished sweep goes on; restart: which is removed
        first. None: none is kept (Sweep.save() writes one).
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    use_python(python)
    names, changes = changes_of("sweep", scenario, pipelines, set)
    options = words_of(
        scenario=scenario, sweep=_axis_words(sweep), study=study, clocks=bool(clocks),
        duration_s=duration_s, from_s=from_s, seeds=seeds, first_seed=first_seed,
        pipelines=names, set=changes, rank_by=rank_by, jobs=_whole("jobs", jobs, 0, 4096) or None,
        restart=bool(restart),
    )  # fmt: skip
    if study == "list":
        raise InputError("study: found 'list', allowed: a name of listing('studies')")
    with tempfile.TemporaryDirectory(prefix="simbench_") as temporary:
        folder = os.path.join(temporary, "sweep") if output is None else os.fspath(output)
        ended = run_command("sweep", [*options, f"--output={folder}"], formats=Sweep.formats,
                            progress=progress)
        files = {}
        for name in sorted(os.listdir(folder)):
            if name != _LOCK:
                with open(os.path.join(folder, name), "rb") as file:
                    files[name] = file.read()
    return Sweep(ended, files)
