"""Command lines in this process: what functions of the package do by the command of their name."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import re
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Union

from . import _simbench
from .errors import Error, InputError
from .progress import Progress
from .results import Path, Result, _warn
from .tables import notebook_html, page_columns

Paths = Union[Path, Sequence[Path]]

# The exit statuses that end in an exception (cli/messages.h).
_BAD_INPUT = (2, 4)
_INTERRUPTED = 130
_INTERNAL_ERROR = 1
#: The status of a gate or a limit that is not kept.
NOT_KEPT = 3


@dataclasses.dataclass(frozen=True)
class Ended:
    """What a command has given."""

    status: int
    results: Dict[str, str]  # by format
    output: str
    notes: List[str]


def paths_of(name: str, of: Paths) -> List[str]:
    """One path or several, as a list that is not empty."""
    if isinstance(of, (str, os.PathLike)):
        return [os.fspath(of)]
    if not isinstance(of, Sequence):
        raise InputError(f"{name}: found {of!r}, allowed: a path or a list of paths")
    paths = [os.fspath(path) for path in of]
    if not paths:
        raise InputError(f"{name}: found an empty list, allowed: one path or more")
    return paths


def joined(name: str, values: Optional[Sequence[Any]]) -> Optional[str]:
    """The value of an option that takes "one,two"."""
    if isinstance(values, str):
        raise InputError(f"{name}: found the text {values!r}, allowed: a list")
    return ",".join(str(value) for value in values) if values else None


def repeated(name: str, values: Union[str, Path, Sequence[Any], None]) -> List[str]:
    """The values of an option that may be repeated: one, or a list."""
    if values is None:
        return []
    if isinstance(values, (str, os.PathLike)):
        return [os.fspath(values)]
    return [os.fspath(value) for value in values]


def sets_of(sets: Optional[Mapping[str, Any]]) -> List[str]:
    """The values of --set."""
    return [f"{pointer}={json.dumps(value)}" for pointer, value in (sets or {}).items()]


def words_of(**options: Any) -> List[str]:
    """Options by their names: True is a flag, a list repeats its option; what is None, False or an
    empty list is left out."""
    words = []
    for name, value in options.items():
        option = "--" + name.strip("_").replace("_", "-")
        if value is None or value is False:
            continue
        for each in value if isinstance(value, list) else [value]:
            words.append(option if each is True else f"{option}={_text(each)}")
    return words


def _text(value: Any) -> str:
    return str(os.fspath(value)) if isinstance(value, os.PathLike) else str(value)


def _in_python(text: str) -> str:
    """"--rate-hz: found ..." says the name of an argument of Python."""
    return re.sub(r"^--([a-z0-9-]+)(?=[: ])", lambda found: found[1].replace("-", "_"), text)


def run_command(
    command: str,
    options: Sequence[str],
    arguments: Sequence[str] = (),
    *,
    formats: Sequence[str] = (),
    progress: Optional[bool] = None,
    unit: str = "run",
) -> Ended:
    """Runs `simbench COMMAND OPTIONS ARGUMENTS`, whose warnings become Python's. `formats`: in which
    the result is wanted, of a command that has several."""
    line = ["simbench", command, *options, *(["--", *arguments] if arguments else [])]
    try:
        with Progress(progress, unit) as shown:
            status, results, output, said = _simbench.run_command(
                line, list(formats), page_columns(), shown.callback
            )
    except InputError as error:
        raise InputError(_in_python(str(error))) from error.__cause__
    if status == _INTERRUPTED:
        raise KeyboardInterrupt
    if status in _BAD_INPUT or status == _INTERNAL_ERROR:
        text = "\n".join(_in_python(text) for kind, text in said if kind == "error")
        raise InputError(text) if status in _BAD_INPUT else Error(text or f"{command} failed")
    _warn([text for kind, text in said if kind == "warning"], 2)
    return Ended(status, results, output, [text for _, text in said])


@contextlib.contextmanager
def archives_of(
    name: str, of: Union[Result, Path, Sequence[Union[Result, Path]]], may_be_none: bool = False
) -> Iterator[List[str]]:
    """Folders of archives; a Result is written to a temporary one."""
    import tempfile

    each_of: Sequence[Union[Result, Path]]
    each_of = [of] if isinstance(of, (str, os.PathLike, Result)) else of
    if not each_of and not may_be_none:
        raise InputError(f"{name}: found an empty list, allowed: one archive or more")
    with tempfile.TemporaryDirectory(prefix="simbench_") as folder:
        paths = []
        for number, each in enumerate(each_of, 1):
            if isinstance(each, Result) and each._archive is not None:
                paths.append(each._archive)
            elif isinstance(each, Result):
                path = os.path.join(folder, str(number), each.scenario)
                os.makedirs(os.path.dirname(path))
                each.save(path)
                paths.append(path)
            else:
                paths.append(os.fspath(each))
        yield paths


class Output:
    """The result of a command, in all of its formats."""

    #: The formats of text().
    formats: Sequence[str] = ("table", "markdown", "json", "html")

    def __init__(self, ended: Ended, data: Optional[Dict[str, Any]] = None) -> None:
        self._ended = ended
        self._data: Dict[str, Any] = (
            json.loads(ended.results["json"]) if data is None else data
        )

    @property
    def notes(self) -> List[str]:
        """What the command says beside its result, a line each."""
        return list(self._ended.notes)

    @property
    def data(self) -> Dict[str, Any]:
        """All of it, as the command prints it with --format json."""
        return self._data

    @property
    def answer(self) -> str:
        """The answer in one paragraph; "" if there is none."""
        return answer_text(self._data.get("answer"))

    def text(self, format: str = "table") -> str:
        """What the command prints; `format`: one of `formats`."""
        if format not in self.formats:
            raise InputError(f"format: found {format!r}, allowed: {', '.join(self.formats)}")
        return self._ended.results[format]

    def __repr__(self) -> str:
        return self.text(self.formats[0]).rstrip("\n")

    def _repr_html_(self) -> Optional[str]:
        return notebook_html(self.text("html")) if "html" in self.formats else None


def answer_text(answer: Optional[Mapping[str, Any]]) -> str:
    """An answer as commands print it: a sentence, then labelled lines."""
    if not answer:
        return ""
    lines = [str(answer["lead"])]
    lines += [f"{line['label']}: {line['text']}" for line in answer["lines"]]
    return "\n".join(lines) + "\n"
