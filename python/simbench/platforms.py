"""Where the compiled module runs, and one line that says so where it does not."""

import platform

#: What a release's wheel is built for.
NEEDED = "Linux with glibc 2.31 or newer on x86_64 or 64-bit Arm, and CPython 3.9 or newer"


def found() -> str:
    """This interpreter and its system, in the words of NEEDED."""
    library, version = platform.libc_ver()
    libc = f"{library} {version}" if library else "no glibc"
    python = f"{platform.python_implementation()} {platform.python_version()}"
    return f"{platform.system()} with {libc} on {platform.machine()}, and {python}"


def load() -> None:
    """Loads the compiled module; ImportError in one line where it cannot be loaded here."""
    try:
        from . import _simbench  # noqa: F401
    except ImportError as error:
        raise ImportError(
            f"simbench's compiled module cannot be loaded ({error}); needed: {NEEDED}; "
            f"found: {found()}. The program of a release's archive, bin/simbench, needs no library and "
            "no Python; `pip install` of the source builds the module for this system",
            name=error.name, path=error.path) from None
