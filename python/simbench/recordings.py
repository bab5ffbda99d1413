"""Stamps that are no text, written as a CSV recording that every command reads: NumPy arrays, .npy,
.npz, XDF and LeRobot datasets."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from .errors import InputError, MissingPackage, OutputError
from .results import Path, _warn

_UNITS_NS = {"s": 1_000_000_000, "ms": 1_000_000, "us": 1_000, "ns": 1}
_Stamps = List[Optional[int]]  # nanoseconds; None where there is none
_Camera = Tuple[str, _Stamps, _Stamps]  # name, sensor, arrival


def _package(name: str, why: str) -> Any:
    try:
        return __import__(name, fromlist=["*"])
    except ImportError as error:
        raise MissingPackage(f"{why} needs the package {name}: pip install {name}") from error


def _from_heading(name: str) -> Optional[str]:
    """"t_ns" says its unit."""
    end = name.rsplit("_", 1)[-1]
    return end if "_" in name and end in _UNITS_NS else None


def _nanoseconds(values: Any, what: str, unit: Optional[str]) -> _Stamps:
    """Each stamp of a column; a date counts from 1970 and has its own unit."""
    numpy = _package("numpy", "a recording of arrays")
    if values.dtype.kind == "M":
        whole = values.astype("datetime64[ns]").astype(numpy.int64)
        return [None if bad else int(ns) for ns, bad in zip(whole, numpy.isnat(values))]
    if unit is None:
        raise InputError(f"{what}: unit: found none, allowed: {', '.join(_UNITS_NS)}")
    if values.dtype.kind in "iu":
        return [int(value) * _UNITS_NS[unit] for value in values]
    if values.dtype.kind != "f":
        raise InputError(f"{what}: found {values.dtype}, allowed: numbers or dates")
    scaled = values.astype(numpy.longdouble) * _UNITS_NS[unit]
    return [int(numpy.rint(ns)) if numpy.isfinite(ns) else None for ns in scaled]


def _camera(name: str, array: Any, unit: Optional[str]) -> _Camera:
    numpy = _package("numpy", "a recording of arrays")
    array = numpy.asarray(array)
    fields = array.dtype.names
    if fields is not None and array.ndim == 1 and 1 <= len(fields) <= 2:
        columns = [
            _nanoseconds(array[field], f"{name}, {field}", _from_heading(field) or unit)
            for field in fields
        ]
    elif fields is None and array.ndim == 1:
        columns = [_nanoseconds(array, name, unit)]
    elif fields is None and array.ndim == 2 and array.shape[1] == 2:
        columns = [_nanoseconds(array[:, i], name, unit) for i in range(2)]
    else:
        raise InputError(
            f"{name}: found an array of shape {array.shape} and {array.dtype}, allowed: a stamp a "
            "frame, or two columns (or fields): the camera's stamp and its arrival"
        )
    return name, columns[0], columns[-1]


def _of_arrays(arrays: Mapping[str, Any], unit: Optional[str]) -> List[_Camera]:
    return [_camera(name, array, unit) for name, array in arrays.items()]


def _of_numpy(path: str, unit: Optional[str]) -> List[_Camera]:
    numpy = _package("numpy", path)
    try:
        loaded = numpy.load(path, allow_pickle=False)
        arrays = {_stem(path): loaded} if path.endswith(".npy") else dict(loaded)
    except (ValueError, OSError, EOFError) as error:
        raise InputError(f"{path}: {error}") from error
    return _of_arrays(arrays, unit)


def _of_xdf(path: str, unit: Optional[str]) -> List[_Camera]:
    pyxdf = _package("pyxdf", path)
    if unit not in (None, "s"):
        raise InputError(f"{path}: unit: found {unit}, allowed: s, which XDF's stamps have")
    streams, _ = pyxdf.load_xdf(path)
    numpy = _package("numpy", path)
    return [
        _camera(stream["info"]["name"][0], numpy.asarray(stream["time_stamps"]), "s")
        for stream in streams
        if len(stream["time_stamps"]) > 0
    ]


def _of_lerobot(path: str, episode: int) -> List[_Camera]:
    """LeRobot has one stamp a row, for all cameras of it."""
    parquet = _package("pyarrow.parquet", path)
    files = sorted(
        os.path.join(folder, name)
        for folder, _, names in os.walk(os.path.join(path, "data"))
        for name in names
        if name.endswith(".parquet")
    )
    stamps: _Stamps = []
    episodes = set()
    for file in files:
        rows = parquet.read_table(file, columns=["timestamp", "episode_index"]).to_pydict()
        episodes.update(rows["episode_index"])
        stamps += [
            round(stamp * _UNITS_NS["s"])
            for stamp, of in zip(rows["timestamp"], rows["episode_index"])
            if of == episode
        ]
    if not stamps:
        raise InputError(f"{path}: episode: found {episode}, allowed: {_some(sorted(episodes))}")
    if len(episodes) > 1:
        _warn([f"{path}: of {len(episodes)} episodes that of number {episode}"])
    return [(_stem(path), stamps, stamps)]


def _some(numbers: Sequence[int]) -> str:
    if not numbers:
        return "a dataset with rows"
    return f"{numbers[0]} to {numbers[-1]}" if len(numbers) > 1 else str(numbers[0])


def _stem(path: str) -> str:
    return os.path.splitext(os.path.basename(os.path.normpath(path)))[0]


def _cameras(source: Any, unit: Optional[str], episode: int) -> List[_Camera]:
    if isinstance(source, Mapping):
        return _of_arrays(source, unit)
    if not isinstance(source, (str, os.PathLike)):
        return [_camera("camera", source, unit)]
    path = os.fspath(source)
    readers: Dict[str, Callable[[str, Optional[str]], List[_Camera]]] = {
        ".npy": _of_numpy,
        ".npz": _of_numpy,
        ".xdf": _of_xdf,
        ".xdfz": _of_xdf,
    }
    info = os.path.join(path, "meta", "info.json")
    if os.path.exists(info):
        with open(info, encoding="utf-8") as file:
            version = json.load(file).get("codebase_version", "")
        if not str(version).startswith(("v2", "v3")):
            raise InputError(f"{info}: codebase_version: found {version!r}, allowed: v2 and v3")
        return _of_lerobot(path, episode)
    reader = readers.get(os.path.splitext(path)[1].lower())
    if reader is None:
        raise InputError(
            f"{path}: allowed: {', '.join(readers)}, a folder of LeRobot, or arrays; simbench reads "
            "other recordings itself (docs/files.md)"
        )
    if not os.path.exists(path):
        raise InputError(f"{path}: there is no such file")
    return reader(path, unit)


def _ms(ns: int) -> str:
    """Exact to the nanosecond."""
    return f"{'-' if ns < 0 else ''}{abs(ns) // 1_000_000}.{abs(ns) % 1_000_000:06d}"


def _cell(name: str) -> str:
    if any(not letter.isprintable() for letter in name):
        raise InputError(f"camera: found {name!r}, allowed: a name of printable letters")
    return '"' + name.replace('"', '""') + '"'


def write_recording(
    output: Path,
    source: "Union[Path, Mapping[str, Any], Any]",
    *,
    unit: Optional[str] = None,
    episode: int = 0,
) -> int:
    """Writes stamps as a CSV recording, which `inspect`, `diagnose`, `replay` and the commands read.

    source: a .npy or .npz file, an XDF file (by the package pyxdf), the folder of a LeRobot dataset
    (by pyarrow; of which one `episode`), an array, or a dict with an array for each camera. An array
    has a stamp a frame, or two columns or fields: the camera's stamp and its arrival. Without
    arrivals the stamps stand for them.

    unit: "s", "ms", "us" or "ns"; dates, fields such as "t_ns", XDF and LeRobot have their own. What
    is no number is left out, with a warning. An `output` that exists is not replaced. Returns the
    number of frames.
    """
    if unit is not None and unit not in _UNITS_NS:
        raise InputError(f"unit: found {unit!r}, allowed: {', '.join(_UNITS_NS)}")
    cameras = _cameras(source, unit, episode)
    lines = ["Stream Type,Index,HW Timestamp (ms),Host Timestamp(ms),camera,host\n"]
    left_out = 0
    for name, sensors, arrivals in cameras:
        for sensor, arrival in zip(sensors, arrivals):
            if sensor is None or arrival is None:
                left_out += 1
            else:
                lines.append(f"frame,0,{_ms(sensor)},{_ms(arrival)},{_cell(name)},host\n")
    if len(lines) == 1:
        raise InputError(f"{output}: found no frame")
    try:
        with open(output, "x", encoding="utf-8", newline="") as file:
            file.writelines(lines)
    except OSError as error:
        raise OutputError(f"{os.fspath(output)}: {error.strerror}") from error
    if left_out:
        _warn([f"{os.fspath(output)}: {left_out} rows without a stamp left out"])
    return len(lines) - 1
