"""Which rigs of real parts meet a requirement, as `simbench advise` says."""

from __future__ import annotations

from typing import Any, List, Mapping, Optional, Sequence, Union

from .command import Output, repeated, run_command, sets_of, words_of
from .errors import InputError
from .results import Path, _whole
from .tables import table


class Advice(Output):
    """Rigs from the cheapest on, with how probably each meets the requirement."""

    @property
    def recommended(self) -> Optional[str]:
        """The cheapest rig that is shown to meet it; None: none is."""
        place = self.data["recommended"]
        return None if place is None else str(self.data["options"][place]["rig"])

    @property
    def table(self) -> Any:
        """A row a rig and pipeline: rig, hosts, cameras_per_host, price_low_eur, price_high_eur,
        pipeline, met (of `seeds` simulated rigs), probability with its 95 % interval low to high,
        margin (allowed / found), frames_dropped, and the medians of the required metrics with their
        units in the names."""
        rows = []
        for option in self.data["options"]:
            rig = {name: option[name] for name in
                   ("rig", "hosts", "cameras_per_host", "price_low_eur", "price_high_eur")}
            for found in option["pipelines"]:
                medians = found["medians"]
                rest = {name: value for name, value in found.items() if name != "medians"}
                rows.append({**rig, **rest, **medians})
        return table(rows)

    @property
    def rare(self) -> Any:
        """With `per_day`, how often a set goes wrong: event, bound_ms, probability with low and high,
        per_day, ...; else None."""
        rare = self.data["rare"]
        return None if rare is None else table(list(rare))


def advise(
    require: Union[str, Sequence[str]],
    cameras: int,
    *,
    camera: Optional[str] = None,
    rate: float = 30,
    hosts: Union[int, str, None] = None,
    parts: Union[Path, Sequence[Path]] = (),
    per_day: bool = False,
    bound_ms: Optional[float] = None,
    pipeline: Optional[str] = None,
    set: Optional[Mapping[str, Any]] = None,
    seeds: int = 72,
    first_seed: int = 1,
    jobs: int = 0,
    progress: Optional[bool] = None,
) -> Advice:
    """Says which rigs of real parts meet a requirement, the cheapest first.

    require: what the rig must do, "amd<0.1ms" or several, which must hold at once: "error<50us",
        "recall>99%", or what the task tolerates: "5mm at 2m/s".
    cameras: how many; camera: which ("d455", "gige_ace", ...); rate: frames a second.
    hosts: how many to try, 4 or "2..8"; None: 1 to 8. parts: files with parts of your own.
    per_day: how often a set of the recommended rig goes wrong, some minutes; bound_ms: the spread of
        a set in ms that counts as wrong; pipeline: another than the recommended one.
    set: changes of every rig's scenario.
    seeds: simulated rigs behind an answer; first_seed; jobs: threads, 0: one for every core.
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    requirements: List[str] = repeated("require", require)
    if not requirements:
        raise InputError("require: found an empty list, allowed: 'amd<0.1ms' or several")
    options = words_of(
        require=requirements, cameras=_whole("cameras", cameras, 1, 1_000_000), camera=camera,
        rate=rate, hosts=hosts, parts=repeated("parts", parts), per_day=bool(per_day),
        bound_ms=bound_ms, pipeline=pipeline, set=sets_of(set),
        seeds=_whole("seeds", seeds, 1, 1_000_000), first_seed=first_seed,
        jobs=_whole("jobs", jobs, 0, 4096) or None,
    )  # fmt: skip
    return Advice(run_command("advise", options, formats=Advice.formats, progress=progress,
                              unit="step"))
