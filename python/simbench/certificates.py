"""How far the frames of each set can be apart, for sure, as `simbench certify` says."""

from __future__ import annotations

import os
from typing import Any, Dict, Mapping, Optional, Sequence, Union

from .command import NOT_KEPT, Ended, Output, joined, repeated, run_command, sets_of, words_of
from .results import Path, _whole
from .tables import table


class Certificates(Output):
    """What no two frames of a set surely exceed, by pipeline, and what limits it."""

    formats = ("table", "markdown", "latex", "json", "html")

    def __init__(self, ended: Ended) -> None:
        super().__init__(ended)
        self._is_met = ended.status != NOT_KEPT

    @property
    def passed(self) -> bool:
        """Whether as many sets are within `within` as `require` asks for; true without it."""
        return self._is_met

    @property
    def assumptions(self) -> Dict[str, float]:
        """What is taken for granted, by name."""
        return dict(self.data["assumptions"])

    @property
    def table(self) -> Any:
        """A row a pipeline: pipeline, captures, sets, certified_p50_ms, certified_p95_ms,
        certified_max_ms (None: unknown), within_share, frames and truth_outside (None: no truth),
        contradicted (captures), ..."""
        rows = []
        for row in self.data["rows"]:
            flat = {name: value for name, value in row.items()
                    if not isinstance(value, (list, dict))}
            flat.update({f"certified_{name}_ms": value
                         for name, value in row["certified_ms"].items()})
            flat["contradicted"] = len(row["contradicted"])
            rows.append(flat)
        return table(rows)

    @property
    def weakest(self) -> Any:
        """What ties the widest pairs, the most frequent first: pipeline, tie ("camera", "hosts"),
        first, second, sets, width_ms, age_s, drift_share."""
        return table([{"pipeline": row["pipeline"], **tie}
                      for row in self.data["rows"] for tie in row["weakest"]])

    @property
    def contradictions(self) -> Any:
        """Captures whose facts contradict what is assumed: pipeline, seed, before_ms, chain (texts),
        possible_ppm."""
        return table([{"pipeline": row["pipeline"], **capture}
                      for row in self.data["rows"] for capture in row["contradicted"]])


def certify(
    input: Path,
    *,
    pipelines: Optional[Sequence[str]] = None,
    within: Optional[str] = None,
    require: Optional[float] = None,
    host_rate_ppm: Optional[float] = None,
    camera_rate_ppm: Optional[float] = None,
    observed_rates_ppm: Optional[float] = None,
    message_ms: Optional[float] = None,
    poll_ms: Optional[float] = None,
    arrival_ms: Optional[float] = None,
    host_stamp_ms: Optional[float] = None,
    estimated_stamp_ms: Optional[float] = None,
    pulse_late_us: Optional[float] = None,
    sensor_stamp_us: Optional[float] = None,
    common_trigger: bool = False,
    trigger_hz: Optional[float] = None,
    trigger_spread_us: Optional[float] = None,
    causal: bool = False,
    clock_log: Union[str, Sequence[str]] = (),
    host_address: Union[str, Sequence[str]] = (),
    pairs: Optional[Path] = None,
    set: Optional[Mapping[str, Any]] = None,
    seeds: int = 1,
    first_seed: int = 1,
    jobs: int = 0,
    progress: Optional[bool] = None,
) -> Certificates:
    """Says for each gathered set how far its frames can have been exposed from each other.

    input: a scenario, whose captures have the truth beside it, or a folder of record().
    pipelines: of it; None: all.
    within: a time with its unit, "500us", for which shares of sets are counted; require: the percent
        of each pipeline's sets that must be within it, Certificates.passed.
    host_rate_ppm, camera_rate_ppm: bounds of the clocks' rate errors; None: 50, or more where the
        scenario's law asks for it; observed_rates_ppm: a margin about the rates that the recording
        shows, in place of both.
    message_ms, poll_ms, arrival_ms: least delays, 0. host_stamp_ms, sensor_stamp_us: largest errors
        of stamps; None: by the scenario. estimated_stamp_ms: that of stamps which a host_sync
        estimated; None: exchanges with such stamps prove nothing.
    common_trigger: pulses of one trigger expose all frames; trigger_hz: its rate, else the
        scenario's; trigger_spread_us: of the exposures of one pulse, 100.
    causal: use only what came before a set's last exposure.
    pulse_late_us: how late a host sees a pulse of its PPS line; None: pulses prove nothing.
    clock_log: of a recording, what a program on a host exchanged meanwhile, "HOST=FILE" each
        (ntpd's rawstats, chrony's measurements.log or refclocks.log); host_address: which servers
        in them are hosts of the rig, "HOST=ADDRESS" each.
    pairs: also write the interval of every pair of frames of every set to this CSV file.
    set, seeds, first_seed, jobs: of a scenario, as for run().
    progress: show it; None: where tqdm is installed and somebody looks.
    """
    options = words_of(
        pipelines=joined("pipelines", pipelines), within=within, require=require,
        host_rate_ppm=host_rate_ppm, camera_rate_ppm=camera_rate_ppm,
        observed_rates_ppm=observed_rates_ppm, message_ms=message_ms, poll_ms=poll_ms,
        arrival_ms=arrival_ms, host_stamp_ms=host_stamp_ms,
        estimated_stamp_ms=estimated_stamp_ms, sensor_stamp_us=sensor_stamp_us,
        pulse_late_us=pulse_late_us, clock_log=repeated("clock_log", clock_log),
        host_address=repeated("host_address", host_address),
        common_trigger=bool(common_trigger), trigger_hz=trigger_hz,
        trigger_spread_us=trigger_spread_us, causal=bool(causal),
        pairs=None if pairs is None else os.fspath(pairs), set=sets_of(set),
        seeds=_whole("seeds", seeds, 1, 1_000_000), first_seed=first_seed,
        jobs=_whole("jobs", jobs, 0, 4096) or None,
    )  # fmt: skip
    return Certificates(run_command("certify", options, [os.fspath(input)],
                                    formats=Certificates.formats, progress=progress))
