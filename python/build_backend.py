"""Builds the wheel for pip (PEP 517), without a network and without packages of its own.

The module is built by tools/build in build/release, beside the libraries that are there already.
What PyPI shows comes from pyproject.toml, the version from CMakeLists.txt.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PACKAGE = os.path.join(ROOT, "build", "release", "python", "simbench")


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
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _check():
    if sys.version_info < (3, 9):
        _fail(f"found Python {sys.version.split()[0]}, needed: 3.9 or newer")
    if sys.implementation.name != "cpython" or not sys.platform.startswith("linux"):
        _fail(f"found {sys.implementation.name} on {sys.platform}, needed: CPython on Linux")


def _run(*command):
    if subprocess.call(command, cwd=ROOT, stdout=sys.stderr) != 0:
        _fail(f"`{' '.join(command)}` failed, see above")


def _build_module():
    """Builds with the interpreter that pip runs; its headers are those of its base installation."""
    _check()
    setup = os.path.join(ROOT, "tools", "setup")
    _run(setup, "build", "--with-python")
    header = os.path.join(sysconfig.get_path("include"), "Python.h")
    if not os.path.exists(header):
        _fail(f"{header}: not found; `apt-get install python3-dev` brings it for Debian's Python")
    _run(
        os.path.join(ROOT, "tools", "build"),
        "release",
        "-DSIMBENCH_BUILD_PYTHON=ON",
        f"-DPython_EXECUTABLE={os.path.realpath(sys.executable)}",
        "simbench_python",
    )


def _package_files():
    """Name in the wheel and path of each file: the interface, the module, and the library that is
    preloaded into real programs."""
    source = os.path.join(ROOT, "python", "simbench")
    for name in sorted(os.listdir(source)):
        if name.endswith((".py", ".pyi")) or name == "py.typed":
            yield f"simbench/{name}", os.path.join(source, name)
    for name in ("_simbench" + sysconfig.get_config_var("EXT_SUFFIX"), "libsimbench_shim.so"):
        yield f"simbench/{name}", os.path.realpath(os.path.join(PACKAGE, name))


def _file_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def _wheel_text():
    return f"Wheel-Version: 1.0\nGenerator: simbench\nRoot-Is-Purelib: false\nTag: {_tag()}\n"


def _info_files():
    return {
        "METADATA": _metadata().encode(),
        "WHEEL": _wheel_text().encode(),
        "LICENSE": _read("LICENSE").encode(),
    }


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = f"simbench-{_version()}.dist-info"
    os.makedirs(os.path.join(metadata_directory, info))
    for name, content in _info_files().items():
        with open(os.path.join(metadata_directory, info, name), "wb") as file:
            file.write(content)
    return info


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _build_module()
    info = f"simbench-{_version()}.dist-info"
    files = {name: _file_bytes(path) for name, path in _package_files()}
    files.update({f"{info}/{name}": content for name, content in _info_files().items()})
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"simbench-{_version()}-{_tag()}.whl"
    path = os.path.join(wheel_directory, wheel)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)  # of 1980: the same files give the same wheel
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            archive.writestr(entry, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    """What Git has of the project: a source distribution is a clone."""
    name = f"simbench-{_version()}"
    listed = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT).decode()
    with tarfile.open(os.path.join(sdist_directory, f"{name}.tar.gz"), "w:gz") as archive:
        for path in filter(None, listed.split("\0")):
            archive.add(os.path.join(ROOT, path), f"{name}/{path}", recursive=False)
    return f"{name}.tar.gz"
