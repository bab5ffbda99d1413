"""Everything that the paper measured, and measured rigs beside what is predicted of them."""

from __future__ import annotations

from typing import Any, Optional, Sequence

from .command import Output, run_command, words_of
from .results import Path, _whole
from .tables import table

_FORMATS = ("table", "markdown", "latex", "json", "html")


class Paper(Output):
    """The paper's numbers, each beside those of its worlds: what `simbench paper` prints."""

    formats = _FORMATS


class Reality(Output):
    """Measured figures of real rigs beside what the bench predicts of them."""

    formats = _FORMATS

    @property
    def table(self) -> Any:
        """A row a measured figure: recording, name, scenario, pipeline, host, quantity, measured_us
        and predicted_us (medians in us), ratio, factor (the allowed one), is_within, used_for."""
        rows = []
        for recording in self.data["recordings"]:
            for row in recording["rows"]:
                measured, predicted = row["measured_us"], row["predicted_us"]
                rest = {name: row[name] for name in
                        ("name", "scenario", "pipeline", "host", "quantity")}
                rows.append({"recording": recording["name"], **rest,
                             "measured_us": measured["median"],
                             "predicted_us": predicted["median"], "ratio": row["ratio"],
                             "factor": row["factor"], "is_within": row["is_within"],
                             "used_for": row["used_for"]})
        return table(rows)


def paper(
    seeds: int = 200,
    *,
    first_seed: int = 1,
    jobs: int = 0,
    no_table_4: bool = False,
    output: Optional[Path] = None,
    progress: Optional[bool] = None,
) -> Paper:
    """Runs what the paper measured and puts it beside its numbers.

    seeds: of each rate; first_seed: the first. jobs: threads; 0: one for every core.
    no_table_4: leave out the reconstruction, which this module has not and says so.
    output: a folder for paper.html with the figures and the archives.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    options = words_of(
        seeds=_whole("seeds", seeds, 1, 1_000_000), first_seed=first_seed,
        jobs=_whole("jobs", jobs, 0, 4096) or None, no_table_4=bool(no_table_4), output=output,
    )  # fmt: skip
    return Paper(run_command("paper", options, formats=_FORMATS, progress=progress))


def reality(
    names: Sequence[str] = (),
    *,
    seeds: Optional[int] = None,
    jobs: int = 0,
    unknown: bool = False,
    progress: Optional[bool] = None,
) -> Reality:
    """Puts measured figures of real rigs beside what the bench predicts of them.

    names: of the recordings; none: all. seeds: None: as each recording says. jobs: threads; 0: one
    for every core. unknown: also run with the other values of what the publications do not give.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    options = words_of(seeds=seeds, jobs=_whole("jobs", jobs, 0, 4096) or None,
                       unknown=bool(unknown))
    return Reality(run_command("reality", options, list(names), formats=_FORMATS,
                               progress=progress, unit="world"))
