"""Results held to a baseline, as `simbench gate` does."""

from __future__ import annotations

import os
from typing import Any, List, Optional, Union

from .command import NOT_KEPT, Ended, Output, archives_of, run_command, words_of
from .errors import InputError
from .results import Path, Result
from .tables import table


class Gate(Output):
    """Whether a result is as good as its baseline: true in a condition if it is."""

    formats = ("text", "json", "junit", "markdown")

    def __init__(self, ended: Ended) -> None:
        super().__init__(ended)
        self._passed = ended.status != NOT_KEPT

    @property
    def passed(self) -> bool:
        """Whether no check has failed and no pipeline has vanished."""
        return self._passed

    def __bool__(self) -> bool:
        return self._passed

    @property
    def table(self) -> Any:
        """A row a check: pipeline, metric, outcome ("same", "changed", "better", "possibly_worse",
        "failed"), baseline, value and margin in the metric's unit, message."""
        return table(list(self.data["checks"]))

    @property
    def reasons(self) -> List[str]:
        """Why it failed, a line each; empty if it passed."""
        vanished = [f"the pipeline {name} of the baseline is not in the result"
                    for name in self.data["vanished_pipelines"]]
        return vanished + [str(check["message"]) for check in self.data["checks"]
                           if check["outcome"] == "failed"]

    def text(self, format: str = "text") -> str:
        """What `simbench gate` prints; `format`: text, json, junit (JUnit XML) or markdown."""
        return super().text(format)


def gate(
    result: Union[Result, Path],
    baseline: Path,
    *,
    mode: str = "exact",
    junit: Optional[Path] = None,
    markdown: Optional[Path] = None,
) -> Gate:
    """Compares a result with a baseline. A gate that fails is no exception: `if not gate(...)`.

    result: a Result, the folder of an archive, or a results.json. baseline: a file of
    save_baseline().
    mode: "exact", with the seeds and the scenario of the baseline: a value of the table may not be
        worse by more than its margin; or "statistical", with 32 seeds or more of any numbers: a mean
        may not, beyond chance.
    junit: a file to which JUnit XML is written as well. markdown: one for a summary.

    Raises InputError for a result that cannot be compared with this baseline.
    """
    with archives_of("result", [result]) as paths:
        options = words_of(baseline=baseline, mode=mode, junit=junit, markdown=markdown)
        return Gate(run_command("gate", options, paths, formats=Gate.formats))


def save_baseline(result: Union[Result, Path], baseline: Path) -> str:
    """Writes a result as a baseline, with the margins of an earlier one there, as `simbench gate
    --save-baseline` does. Returns the path."""
    if not os.fspath(baseline):
        raise InputError("baseline: found '', allowed: the path of a file")
    with archives_of("result", [result]) as paths:
        run_command("gate", words_of(save_baseline=baseline), paths)
    return os.fspath(baseline)
