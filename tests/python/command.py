"""The command `simbench`, for comparisons, and what several tests need."""

import os
import subprocess
import sys

PROGRAM = os.environ["SIMBENCH_PROGRAM"]
SOURCE = os.environ["SIMBENCH_SOURCE_DIR"]


def simbench(*arguments, status=0):
    """Standard output of the command, which must end with this status; else standard error."""
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)
    if done.returncode != status:
        raise AssertionError(f"{arguments}: status {done.returncode}: {done.stderr}")
    return done.stdout if status == 0 else done.stderr


def python(code, *arguments, **environment):
    """Runs code in an interpreter of its own."""
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environment},
    )


def without_performance(data):
    return {name: value for name, value in data.items() if name != "performance"}
