"""Tables of the libraries as Python has them: pandas, NumPy, or plain lists."""

from __future__ import annotations

import csv
import html
import importlib
import io
import os
from typing import Any, Callable, Optional, Union

from . import _simbench
from .errors import MissingPackage, OutputError

#: Columns of words; all others are numbers.
_WORDS = frozenset(
    "pipeline scenario metric measure unit published_figures ground_truth verified notes changed "
    "camera stream pipeline_a pipeline_b verdict metric_id a b kind".split()
) | frozenset(_simbench.stages())
_COUNTS = frozenset(_simbench.counts()) | {"seed", "host", "scored_seeds"}


def _cell(column: str, text: str) -> Any:
    if column in _WORDS:
        return text
    if text == "":
        return float("nan")
    try:
        return int(text) if column in _COUNTS or column.endswith("_ns") else float(text)
    except ValueError:
        return text


def records(text: str) -> list[dict[str, Any]]:
    """The lines of a CSV text as the libraries write it; what does not exist is NaN."""
    return [
        {column: _cell(column, cell) for column, cell in line.items()}
        for line in csv.DictReader(io.StringIO(text))
    ]


def table(rows: list[dict[str, Any]]) -> Any:
    """A pandas DataFrame of the rows; without pandas the rows themselves."""
    try:
        import pandas
    except ImportError:
        return rows
    frame = pandas.DataFrame(rows)
    for name in frame.columns:
        if name.endswith("_ns") and all(_is_whole(row[name]) for row in rows):
            # Whole nanoseconds since 1970 are more than a float holds.
            whole = [int(row[name]) if row[name] == row[name] else None for row in rows]
            frame[name] = pandas.array(whole, dtype="Int64")
    return frame


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) or value != value


def needed(name: str, what: str) -> Any:
    """A module that `what` needs. Raises MissingPackage."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.split(".", 1)[0]
        raise MissingPackage(f"{what} needs {package}, which is missing: {error}") from None


def array(rows: _simbench.Rows) -> Any:
    """A structured NumPy array in the memory of the rows, which it keeps alive."""
    try:
        import numpy
    except ImportError as error:
        raise MissingPackage("frames() needs NumPy, which is missing: " + str(error)) from None
    names, formats, offsets = zip(*rows.fields)
    dtype = numpy.dtype(
        {"names": names, "formats": formats, "offsets": offsets, "itemsize": rows.row_bytes}
    )
    return numpy.asarray(rows).view(dtype)


_STYLE = (
    "<style>.simbench th,.simbench td{text-align:left;padding:2px 8px}"
    ".simbench th,.simbench h2{font-weight:bold;font-size:1em}</style>"
)


def notebook_html(body: str) -> str:
    """The reports' HTML for a notebook, which has a style of its own."""
    return f'<div class="simbench">{_STYLE}{body}</div>'


def paragraphs(lines: list[str]) -> str:
    return "".join(f"<p>{html.escape(line)}</p>" for line in lines)


def page_columns() -> Optional[int]:
    """The width of the terminal; None where there is none."""
    import shutil
    import sys

    if sys.stdout is None or not sys.stdout.isatty():
        return None
    return shutil.get_terminal_size().columns


def page_text(text_of: Callable[[], str]) -> str:
    """What text_of() returns, for a terminal of this width."""
    _simbench.set_page_width(page_columns())
    return text_of().rstrip("\n")


def write_text(path: Union[str, "os.PathLike[str]"], text: str) -> None:
    """Writes a file. Raises OutputError."""
    try:
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(text)
    except OSError as error:
        raise OutputError(f"{os.fspath(path)}: {error.strerror}") from error
