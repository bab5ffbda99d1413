"""`python3 -m simbench ARGUMENTS` is the command `simbench` with algorithms in Python.

It is the command that pip installs, and `simbench run --python FILE ...` goes on as this.
"""

import importlib.util
import os
import signal
import sys
import traceback
from typing import List, Optional

from . import _simbench


def import_algorithms(file: str) -> None:
    """Imports a file, whose decorators register its algorithms."""
    if not os.path.isfile(file):
        raise ImportError(f"--python {file}: no such file")
    folder, name = os.path.split(os.path.abspath(file))
    if folder not in sys.path:
        sys.path.insert(0, folder)  # for the modules beside it
    module_name = os.path.splitext(name)[0]
    spec = importlib.util.spec_from_file_location(module_name, os.path.join(folder, name))
    if spec is None or spec.loader is None:
        raise ImportError(f"--python {file}: found no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[module_name] = module
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        text = error.msg if isinstance(error, SyntaxError) else str(error)
        name = type(error).__name__
        raise ImportError(f"--python {file}:{_line(error, file)}: {name}: {text}") from error


def _line(error: BaseException, file: str) -> int:
    """The last line of the file that the error has come from."""
    if isinstance(error, SyntaxError) and error.lineno:
        return error.lineno
    frames = [frame for frame in traceback.extract_tb(error.__traceback__)
              if os.path.abspath(frame.filename) == os.path.abspath(file)]
    return frames[-1].lineno or 1 if frames else 1


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command line and returns its exit status."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # ends at a closed pipe, as the program does
    return _simbench.command_line(["simbench", *sys.argv[1:]] if arguments is None else arguments)


if __name__ == "__main__":
    sys.exit(main())
