"""Builds the wheel for pip (PEP 517), without a network and without packages of its own.

The module is built by tools/build in build/release, beside the libraries that are there already; pip
shows its progress on a terminal. What PyPI shows comes from pyproject.toml, the version from
CMakeLists.txt.

    python3 python/build_backend.py WHEEL_DIRECTORY MODULE SHIM TAG

writes a wheel of a module that was built elsewhere (write_wheel()) and prints its name.
"""

import base64
import functools
import glob
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.join(ROOT, "build", "release")


def _fail(text):
    sys.exit(f"simbench: {text}")


def _read(name):
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return file.read()


def _version():
    return re.search(r"^project\(simbench VERSION ([0-9.]+)", _read("CMakeLists.txt"), re.M)[1]


def _project():
    """The scalars and lists of pyproject.toml's [project]; Python has a TOML reader from 3.11 on."""
    text = _read("pyproject.toml").split("[project]\n")[1].split("\n[")[0]
    values = dict(re.findall(r'^([a-z-]+) = "(.*)"$', text, re.M))
    for name, items in re.findall(r"^([a-z-]+) = \[(.*?)\]$", text, re.M | re.S):
        values[name] = re.findall(r'"(.*?)"', items)
    return values


def _metadata():
    project = _project()
    extras = re.findall(r'"(.*?)"', _read("pyproject.toml").split("dependencies]\nall = ")[1])
    lines = [
        "Metadata-Version: 2.1",
        "Name: simbench",
        f"Version: {_version()}",
        f"Summary: {project['description']}",
        "License: Apache-2.0",
        f"Keywords: {','.join(project['keywords'])}",
        *(f"Classifier: {each}" for each in project["classifiers"]),
        f"Requires-Python: {project['requires-python']}",
        "Provides-Extra: all",
        *(f"Requires-Dist: {each} ; extra == 'all'" for each in extras),
        "Description-Content-Type: text/markdown",
    ]
    return "\n".join(lines) + "\n\n" + _read("README.md")


def _tag():
    """Every CPython from 3.9 on, on machines like this one."""
    return f"cp39-abi3-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _check():
    if sys.version_info < (3, 9):
        _fail(f"found Python {sys.version.split()[0]}, needed: 3.9 or newer")
    if sys.implementation.name != "cpython" or not sys.platform.startswith("linux"):
        _fail(f"found {sys.implementation.name} on {sys.platform}, needed: CPython on Linux")


@functools.lru_cache(maxsize=None)
def _terminal():
    """Where somebody waits for pip, which keeps what a backend prints: pip's own standard error, if
    that is a terminal, below pip's line; else None."""
    try:
        terminal = open(f"/proc/{os.getppid()}/fd/2", "wb", buffering=0)
    except OSError:
        return None
    if os.isatty(terminal.fileno()):
        terminal.write(b"\n")
        return terminal
    terminal.close()
    return None


def _run(*command):
    """Shows a terminal what the command says, else keeps it for pip, which shows it after an error."""
    terminal = None if os.isatty(2) else _terminal()
    if subprocess.call(command, cwd=ROOT, stdout=sys.stderr, stderr=terminal) != 0:
        _fail(f"`{' '.join(command)}` failed, see above")


def _headers():
    """An option for the headers of the interpreter that pip runs; none for those of the system, which
    CMake finds. One module serves all versions, so any will do."""
    if glob.glob("/usr/include/python3.*/Python.h"):
        return []
    own = sysconfig.get_path("include")
    if os.path.exists(os.path.join(own, "Python.h")):
        return [f"-DPython_INCLUDE_DIR={own}"]
    _run(os.path.join(ROOT, "tools", "setup"), "build", "--with-python")
    return []


def _build_module():
    """Compiles the module alone where tools/run has built the libraries (build/release), else all."""
    _check()
    _run(os.path.join(ROOT, "tools", "setup"), "build")
    options = ["-DSIMBENCH_BUILD_PYTHON=ON", *_headers()]
    if not os.path.exists(os.path.join(BUILD, "CMakeCache.txt")):  # as tools/run has it
        options += ["-DSIMBENCH_BUILD_TESTS=OFF", "-DSIMBENCH_BUILD_BENCH=OFF"]
    _run(os.path.join(ROOT, "tools", "build"), "release", *options, "simbench_python")


def _interface_files():
    """Name in the wheel and path of each file in Python."""
    source = os.path.join(ROOT, "python", "simbench")
    for name in sorted(os.listdir(source)):
        if name.endswith((".py", ".pyi")) or name == "py.typed":
            yield f"simbench/{name}", os.path.join(source, name)


def _file_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def _wheel_text(tag):
    interpreter, abi, platforms = tag.split("-")
    tags = [f"Tag: {interpreter}-{abi}-{platform}\n" for platform in platforms.split(".")]
    return "Wheel-Version: 1.0\nGenerator: simbench\nRoot-Is-Purelib: false\n" + "".join(tags)


def _info():
    return f"simbench-{_version()}.dist-info"


def _info_files(tag):
    return {
        "METADATA": _metadata().encode(),
        "WHEEL": _wheel_text(tag).encode(),
        "entry_points.txt": b"[console_scripts]\nsimbench = simbench.__main__:main\n",
        "LICENSE": _read("LICENSE").encode(),
    }


def write_wheel(wheel_directory, module_path, shim_path, tag):
    """Writes a wheel of this module and of the library that is preloaded into real programs (shim),
    and returns its name. The same files and tag give the same bytes with the same Python.

    `tag`: cp39-abi3-linux_x86_64, or several platforms as cp39-abi3-manylinux_2_28_x86_64.linux_x86_64
    """
    files = {name: _file_bytes(path) for name, path in _interface_files()}
    files["simbench/_simbench.abi3.so"] = _file_bytes(module_path)
    files["simbench/libsimbench_shim.so"] = _file_bytes(shim_path)
    info = _info()
    files.update({f"{info}/{name}": content for name, content in _info_files(tag).items()})
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"simbench-{_version()}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w") as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)  # of 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            archive.writestr(entry, content)
    return wheel


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    os.makedirs(os.path.join(metadata_directory, _info()))
    for name, content in _info_files(_tag()).items():
        with open(os.path.join(metadata_directory, _info(), name), "wb") as file:
            file.write(content)
    return _info()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _build_module()
    package = os.path.join(BUILD, "python", "simbench")
    module, shim = (os.path.join(package, name)
                    for name in ("_simbench.abi3.so", "libsimbench_shim.so"))
    return write_wheel(wheel_directory, module, shim, _tag())


def build_sdist(sdist_directory, config_settings=None):
    """What Git has of the project: a source distribution is a clone."""
    name = f"simbench-{_version()}"
    listed = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT).decode()
    with tarfile.open(os.path.join(sdist_directory, f"{name}.tar.gz"), "w:gz") as archive:
        for path in filter(None, listed.split("\0")):
            archive.add(os.path.join(ROOT, path), f"{name}/{path}", recursive=False)
    return f"{name}.tar.gz"


if __name__ == "__main__":
    if len(sys.argv) != 5:
        _fail("usage: build_backend.py WHEEL_DIRECTORY MODULE SHIM TAG")
    print(write_wheel(*sys.argv[1:]))
