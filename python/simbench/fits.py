"""A scenario fitted to a recording, as `simbench fit` does."""

from __future__ import annotations

import json
import os
import tempfile
from typing import Any, Dict, List, Optional, Sequence

from .command import Ended, Output, Paths, joined, paths_of, run_command, words_of
from .results import Path, _whole
from .tables import records, table, write_text

_FORMATS = ("table", "json", "fit_json")


class Fit(Output):
    """A model of a rig: the simulator with the rig's own numbers, and what they rest on."""

    formats = ("table", "json")

    def __init__(self, ended: Ended, model: str, path: Optional[str]) -> None:
        super().__init__(ended)
        self._fit: Dict[str, Any] = json.loads(ended.results["fit_json"])
        self._model = model
        self._path = path

    @property
    def path(self) -> Optional[str]:
        """The scenario file; None if no `output` was named."""
        return self._path

    @property
    def model(self) -> Dict[str, Any]:
        """The scenario."""
        return dict(json.loads(self._model))

    @property
    def fit(self) -> Dict[str, Any]:
        """The fit, as `simbench fit --format json` prints it without --rank."""
        return self._fit

    @property
    def data(self) -> Dict[str, Any]:
        """As `simbench fit --format json` prints it: the fit, with `rank` the ranking."""
        return self._data

    @property
    def answer(self) -> str:
        """Whether the model predicts the recording, in a sentence."""
        return str(self._fit["trust"]["text"])

    @property
    def holds(self) -> bool:
        """Whether the model predicts; False: something speaks against it."""
        return bool(self._fit["trust"]["holds"])

    @property
    def evidence(self) -> List[str]:
        """What each fitted value rests on, a line each."""
        return list(self._fit["evidence"])

    @property
    def table(self) -> Any:
        """The drift of each camera in ppm, a row a check and camera: check, camera, recorded, error
        (standard), low and high of its 95 % interval, simulated."""
        return table([
            {"check": check["check"], "camera": skew["camera"],
             "recorded_ppm": skew["recorded"]["value"], "error_ppm": skew["recorded"]["error"],
             "low_ppm": skew["recorded"]["low"], "high_ppm": skew["recorded"]["high"],
             "simulated_ppm": (skew["simulated"] or {}).get("value")}
            for check in self._fit["checks"] for skew in check["skew_ppm"]
        ])  # fmt: skip

    @property
    def ranking(self) -> Any:
        """With `rank`, a row a pipeline with the columns of run().table; else None."""
        text = self._ended.results.get("csv")
        return table(records(text)) if text is not None else None

    def save(self, path: Path) -> None:
        """Writes the scenario to a file."""
        write_text(path, self._model)


def fit(
    inputs: Paths,
    output: Optional[Path] = None,
    *,
    base: Optional[Path] = None,
    pipeline: Optional[str] = None,
    seed: Optional[int] = None,
    topics: Sequence[str] = (),
    columns: Optional[str] = None,
    one_host: bool = False,
    rank: bool = False,
    verbose: bool = False,
    seeds: int = 8,
    jobs: int = 0,
    progress: Optional[bool] = None,
) -> Fit:
    """Fits a scenario to a recording.

    inputs: a recording folder, or files of real cameras; topics (of bags) and columns (of CSV) as
        for inspect().
    output: the scenario file to write; None: Fit.model and Fit.save() have it.
    base: the scenario that gives what is not fitted. pipeline, seed: which capture of a folder.
    one_host: one computer stamped all arrivals.
    rank: then simulate the model under every pipeline of the leaderboard that it can run, over
        `seeds` seeds and by `jobs` threads (0: one for every core); verbose: text() has all rows
        and metrics.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    chosen = words_of(
        base=base, pipeline=pipeline, seed=seed, topics=joined("topics", topics), columns=columns,
        one_host=bool(one_host), rank=bool(rank), verbose=bool(verbose),
        seeds=_whole("seeds", seeds, 1, 1_000_000), jobs=_whole("jobs", jobs, 0, 4096) or None,
    )  # fmt: skip
    recording = paths_of("inputs", inputs)
    with tempfile.TemporaryDirectory(prefix="simbench_") as folder:
        path = os.path.join(folder, "model.json") if output is None else os.fspath(output)
        ended = run_command(
            "fit", [*chosen, f"--output={path}"], recording,
            formats=[*_FORMATS, *(["csv"] if rank else [])], progress=progress,
        )  # fmt: skip
        with open(path, encoding="utf-8") as file:
            model = file.read()
    return Fit(ended, model, None if output is None else path)
