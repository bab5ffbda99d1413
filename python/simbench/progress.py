"""Progress of long work: tqdm, if it is there and somebody looks."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Any, Callable, Optional, Type, cast

#: Seconds after which a bar appears.
_PATIENCE_S = 1.0


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and type(shell).__name__ == "ZMQInteractiveShell"


def _somebody_looks() -> bool:
    return (sys.stderr is not None and sys.stderr.isatty()) or _in_notebook()


def _bar() -> Callable[..., Any]:
    """tqdm's bar: the notebook's where it can be drawn, else that of lines. tqdm.auto would choose
    alike, and warns of a notebook without ipywidgets. Raises ImportError."""
    from tqdm.std import tqdm

    if not _in_notebook():
        return cast(Callable[..., Any], tqdm)
    from tqdm import notebook

    return cast(Callable[..., Any], tqdm if notebook.IProgress is None else notebook.tqdm)


class Progress:
    """A context whose `callback` the libraries call with (done, total); None if nothing is shown.

    `wanted`: True, False, or None for "if somebody looks".
    """

    def __init__(self, wanted: Optional[bool], unit: str) -> None:
        self._unit = unit
        self._bar: Any = None
        self._start = time.monotonic()
        self._make: Optional[Callable[..., Any]] = None
        if wanted or (wanted is None and _somebody_looks()):
            try:
                self._make = _bar()
            except ImportError:
                if wanted:
                    self._make = _Lines
        self.callback = self._update if self._make is not None else None

    def _update(self, done: int, total: int) -> None:
        if self._bar is None:
            if (self._make is None or time.monotonic() - self._start < _PATIENCE_S
                    or done == total):
                return
            self._bar = self._make(total=total, unit=self._unit, leave=False)
        if total != self._bar.total or done < self._bar.n:  # the next part of the work
            self._bar.reset(total=total)
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> "Progress":
        return self

    def __exit__(
        self,
        kind: Optional[Type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        if self._bar is not None:
            self._bar.close()


class _Lines:
    """In place of tqdm: a line at each tenth, on standard error."""

    def __init__(self, total: int, unit: str, leave: bool) -> None:
        self.total, self.n, self._unit, self._tenth = total, 0, unit, 0

    def update(self, more: int) -> None:
        self.n += more
        tenth = 10 * self.n // self.total if self.total else 0
        if tenth > self._tenth:
            self._tenth = tenth
            print(f"{self.n} of {self.total} {self._unit}s", file=sys.stderr)

    def reset(self, total: int) -> None:
        self.total, self.n, self._tenth = total, 0, 0

    def close(self) -> None:
        pass
