"""The hosts' clocks alone."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, List, Mapping, Optional, Sequence

from . import _simbench
from .progress import Progress
from .results import Path, _warn, _whole, request_of
from .tables import notebook_html, page_text, records, table


class Clocks:
    """Time error, stability and holdover of the hosts' clocks: what `simbench clocks` prints.

    adev, mdev, hdev (no unit), tdev_ms and mtie_ms are curves over tau: pipeline, tau_s, value.
    """

    def __init__(self, run: _simbench.ClockRun) -> None:
        self._run = run

    @property
    def notes(self) -> List[str]:
        """What is doubtful about the results, a line each; mostly empty."""
        return self._run.notes

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as `simbench clocks --format json` prints it."""
        return json.loads(self._run.json())

    @property
    def table(self) -> Any:
        """A row a pipeline, with the median of each metric."""
        rows: Dict[str, Dict[str, Any]] = {}
        for line in records(self._run.csv()):
            row = rows.setdefault(line["pipeline"], {"pipeline": line["pipeline"]})
            if line["tau_s"] != line["tau_s"]:  # NaN: a metric, and no point of a curve
                row[line["measure"]] = line["value"]
        return table(list(rows.values()))

    @property
    def seeds(self) -> Any:
        """Every value: scenario, pipeline, seed, metric, unit, value."""
        return table(records(self._run.tidy_csv()))

    @property
    def time_errors(self) -> Any:
        """Of the first seed's slaves: pipeline, seed, time_s, host, te_s."""
        return table(records(self._run.series_csv()))

    def curve(self, measure: str) -> Any:
        """adev, mdev, hdev, tdev_ms or mtie_ms: pipeline, tau_s, value."""
        return table(
            [
                {name: line[name] for name in ("pipeline", "tau_s", "value")}
                for line in records(self._run.csv())
                if line["measure"] == measure and line["tau_s"] == line["tau_s"]
            ]
        )

    @property
    def adev(self) -> Any:
        """The Allan deviation."""
        return self.curve("adev")

    @property
    def mdev(self) -> Any:
        """The modified Allan deviation."""
        return self.curve("mdev")

    @property
    def hdev(self) -> Any:
        """The Hadamard deviation."""
        return self.curve("hdev")

    @property
    def tdev_ms(self) -> Any:
        """The time deviation."""
        return self.curve("tdev_ms")

    @property
    def mtie_ms(self) -> Any:
        """The maximum time interval error."""
        return self.curve("mtie_ms")

    def save(self, folder: Path) -> None:
        """Writes the archive that `simbench clocks --output` writes."""
        self._run.save(os.fspath(folder))

    def __repr__(self) -> str:
        return page_text(self._run.text)

    def _repr_html_(self) -> str:
        return notebook_html(self._run.html())


def clocks(
    scenario: Path,
    pipelines: Optional[Sequence[str]] = None,
    seeds: int = 8,
    *,
    duration_s: int = 36_000,
    from_s: int = 300,
    set: Optional[Mapping[str, Any]] = None,
    first_seed: int = 1,
    jobs: int = 0,
    progress: Optional[bool] = None,
) -> Clocks:
    """Runs the hosts' clocks alone, as `simbench clocks` does: from a cold start for duration_s
    seconds, then 600 s without the master and 3600 s with it again. Seconds from from_s on count."""
    request = request_of("clocks", scenario, pipelines, seeds, first_seed, set, jobs)
    most = 31_000_000
    duration, start = _whole("duration_s", duration_s, 1, most), _whole("from_s", from_s, 0, most)
    with Progress(progress, "run") as shown:
        result = Clocks(_simbench.run_clocks(request, duration, start, shown.callback))
    _warn(result.notes)
    return result
