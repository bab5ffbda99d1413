"""Algorithms in Python, as rows beside simbench's own.

    @simbench.device_time("mean_of_last", window=30)
    class MeanOfLast:
        def __init__(self, window):
            self.offsets = collections.deque(maxlen=window)

        def stamp(self, sample):
            self.offsets.append(sample.arrival_ns - sample.sensor_ns)
            return sample.sensor_ns + sum(self.offsets) / len(self.offsets)

    simbench.run("18cam_6host_45fps", pipelines=["yoon2021_both+mean_of_last"])

Keywords of a decorator are parameters of the algorithm with their defaults; scenarios set them
under /algorithms/<name>/<parameter>. To decorate again, as a cell of a notebook that runs twice
does, replaces the algorithm. docs/python.md explains all four stages.
"""

import dataclasses
import inspect
import math
import types
from typing import (
    Any, Callable, Dict, Iterable, NamedTuple, NoReturn, Optional, Sequence, TypeVar, Union,
)  # fmt: skip

from . import _simbench
from .errors import MissingPackage
from .host import Camera, Host

Sample = _simbench.Sample
Frame = _simbench.Frame

_Class = TypeVar("_Class", bound=type)
_Function = TypeVar("_Function", bound=Callable[..., Any])
_COLUMNS = ("sensor_ns", "arrival_ns", "arrival_steady_ns", "exposure_us")


class Poll(NamedTuple):
    """The camera's clock, read over its control interface between t0 and t1."""

    device_ns: int
    t0_ns: int
    t1_ns: int
    t0_steady_ns: int
    t1_steady_ns: int


class Adjustment(NamedTuple):
    """A change of the host's system clock: at that steady time, from `before` to `after`."""

    at_steady_ns: int
    before_ns: int
    after_ns: int
    rate_ppb: float


class GatheringSetup(NamedTuple):
    """What a gatherer is made for."""

    sources: int
    period_ns: int  # nominal frame period
    interval_ns: int  # the largest range of a set
    queue_limit: Optional[int]  # frames that may wait per source; None: as the algorithm will


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A parameter with its range and meaning, in place of its bare default."""

    default: Union[bool, int, float, str]
    low: float = -math.inf
    high: float = math.inf
    choices: Sequence[str] = ()
    meaning: str = ""
    source: str = "the algorithm's author"


@dataclasses.dataclass(frozen=True)
class Pipeline:
    """A pipeline of a scenario with other stages. See pipeline()."""

    name: str
    base: Optional[str]
    host_sync: Optional[str]
    capture_alignment: Optional[str]  # "": none
    device_time: Optional[str]
    gathering: Optional[str]


def _place(function: Callable[..., Any]) -> tuple[str, int]:
    code = inspect.unwrap(function).__code__
    return code.co_filename, code.co_firstlineno


def _refuse(function: Any, kind: str, text: str) -> NoReturn:
    try:
        file, line = inspect.getsourcefile(function), inspect.getsourcelines(function)[1]
    except (OSError, TypeError):
        file, line = "?", 0
    raise TypeError(f"{kind} ({file}:{line}): {text}")


def _parameter(name: str, value: Any) -> Dict[str, Any]:
    stated = value if isinstance(value, Parameter) else Parameter(value)
    default = stated.default
    if not isinstance(default, (bool, int, float, str)):
        raise TypeError(f"parameter {name}: found {default!r}, allowed: a number, True or False, "
                        "a text")
    return {"name": name, "default": default, "low": stated.low, "high": stated.high,
            "choices": list(stated.choices), "meaning": stated.meaning, "source": stated.source,
            "whole": isinstance(default, int) and not isinstance(default, bool)}


def _summary(documented: Any) -> str:
    lines = (inspect.getdoc(documented) or "").splitlines()
    return lines[0] if lines and documented.__doc__ else "an algorithm in Python"


def _definition(name: str, decorated: Any, kind: str, method: Callable[..., Any],
                parameters: Dict[str, Any]) -> Dict[str, Any]:
    file, line = _place(method)
    return {"name": name, "summary": _summary(decorated), "kind": kind, "method": method.__name__,
            "file": file, "line": line, "needs": [],
            "parameters": [_parameter(*item) for item in parameters.items()]}


def _check_call(owner: Any, kind: str, function: Callable[..., Any], shape: str,
                positional: Sequence[Any], named: Iterable[str] = ()) -> None:
    try:
        inspect.signature(function).bind(*positional, **dict.fromkeys(named))
    except TypeError as error:
        _refuse(owner, kind, f"{shape} cannot be called: {error}")


def _maker(cls: type, kind: str, parameters: Dict[str, Any], **further: Any) -> Callable[..., Any]:
    """What makes an object: by __init__, or, where the class has none, by attributes."""
    initialize: Callable[..., None] = getattr(cls, "__init__")
    if initialize is object.__init__:

        def with_attributes(**values: Any) -> Any:
            made = cls()
            for name, value in values.items():
                setattr(made, name, value)
            return made

        return with_attributes
    names = {**further, **parameters}
    _check_call(cls, kind, initialize, f"__init__(self, {', '.join(names)})", [None], names)
    return cls


def _method(cls: type, kind: str, name: str) -> Callable[..., Any]:
    method = inspect.getattr_static(cls, name)
    if not inspect.isfunction(method):
        _refuse(cls, kind, f"{name}: found {type(method).__name__}, allowed: a plain method")
    if inspect.iscoroutinefunction(method):
        _refuse(cls, kind, f"{name}: found async def, allowed: def")
    return method


def _check_is_class(cls: Any, decorator: str) -> str:
    if not inspect.isclass(cls):
        raise TypeError(f"@simbench.{decorator}: found {cls!r}, allowed: a class")
    return f"class {cls.__name__}"


def device_time(name: str, **parameters: Any) -> Callable[[_Class], _Class]:
    """Registers a class that tells when the frames of one camera were exposed.

    The class has stamp(self, sample), which returns the global stamp of the newest frame, or
    stamp_all(self, sensor_ns, arrival_ns), which gets all frames of the recording as arrays and
    returns as many stamps. It may have on_poll(self, poll), on_adjustment(self, adjustment),
    `from_first_frame = True` and `relative = True`. Stamps are ns.

    name: under which scenarios and pipelines know it. parameters: its defaults, by their names.
    """

    def register(cls: _Class) -> _Class:
        kind = _check_is_class(cls, "device_time")
        methods = [method for method in ("stamp", "stamp_all") if hasattr(cls, method)]
        if len(methods) != 1:
            _refuse(cls, kind, f"found {' and '.join(methods) or 'no method'}, allowed: "
                    "stamp(self, sample) or stamp_all(self, sensor_ns, arrival_ns)")
        method = _method(cls, kind, methods[0])
        definition = _definition(name, cls, kind, method, parameters)
        if methods[0] == "stamp":
            _check_call(cls, kind, method, "stamp(self, sample)", [None] * 2)
        else:
            definition["columns"] = _columns(cls, kind, method)
        defaults = {item["name"]: item["default"] for item in definition["parameters"]}
        definition["make"] = _maker(cls, kind, defaults)
        for hook in ("on_poll", "on_adjustment"):
            definition[hook] = hasattr(cls, hook)
            if definition[hook]:
                _check_call(cls, kind, _method(cls, kind, hook), f"{hook}(self, value)", [None] * 2)
        if definition["on_poll"]:
            definition["needs"] = ["polls"]
        for trait in ("from_first_frame", "relative"):
            definition[trait] = bool(getattr(cls, trait, False))
        _simbench.register_device_time(definition)
        setattr(cls, "simbench_name", name)
        return cls

    return register


def _columns(cls: type, kind: str, method: Callable[..., Any]) -> list[str]:
    columns = list(inspect.signature(method).parameters)[1:]
    unknown = [column for column in columns if column not in _COLUMNS]
    if unknown or not columns:
        _refuse(cls, kind, f"stamp_all: found the arguments {', '.join(columns) or '(none)'}, "
                f"allowed: any of {', '.join(_COLUMNS)}")
    return columns


def column_of(cells: bytearray) -> Any:
    """A column of stamp_all(): an array of int64 in this memory."""
    try:
        import numpy
    except ImportError as error:
        raise MissingPackage(f"stamp_all() needs NumPy, which is missing: {error}") from None
    return numpy.frombuffer(cells, numpy.int64)


def stamps_in(result: Any, frames: int) -> Union[str, tuple[bool, bytes]]:
    """What stamp_all() returned: whether it is int64, else float64, and its bytes.

    Else what it is instead; a result that is no array has no words here.
    """
    import numpy

    if not isinstance(result, numpy.ndarray):
        return ""
    if result.dtype not in (numpy.int64, numpy.float64):
        return f"an array of {result.dtype}"
    if result.shape != (frames,):
        return f"an array of shape {result.shape}"
    return result.dtype == numpy.int64, numpy.asarray(result).tobytes()


def gathering(name: str, **parameters: Any) -> Callable[[_Class], _Class]:
    """Registers a class that finds the frames that belong together.

    push(self, frame) gets the frames of all cameras in order of arrival and returns the sets that
    are now known, a list of lists of frames, or None. The class is made with
    setup=GatheringSetup(...) and its parameters.

    name, parameters: as for device_time().
    """

    def register(cls: _Class) -> _Class:
        kind = _check_is_class(cls, "gathering")
        if not hasattr(cls, "push"):
            _refuse(cls, kind, "found no method, allowed: push(self, frame)")
        method = _method(cls, kind, "push")
        _check_call(cls, kind, method, "push(self, frame)", [None] * 2)
        definition = _definition(name, cls, kind, method, parameters)
        defaults = {item["name"]: item["default"] for item in definition["parameters"]}
        definition["make"] = _maker(cls, kind, defaults, setup=None)
        definition["from_first_frame"] = bool(getattr(cls, "from_first_frame", False))
        _simbench.register_gathering(definition)
        setattr(cls, "simbench_name", name)
        return cls

    return register


def host_sync(name: str, *, server: Optional[Callable[..., Any]] = None, needs: Sequence[str] = (),
              **parameters: Any) -> Callable[[_Function], _Function]:
    """Registers an `async def function(host, settings)` that disciplines a slave's clock.

    The master answers host.channel(0).exchange(...) by itself. With server=, an
    `async def serve(host, client, settings)`, the algorithm answers instead: one runs on the master
    for each slave. The capture begins when all have returned; with a parameter warm_up_s it is a
    service, whose capture begins after that time and which goes on for ever.

    name, parameters: as for device_time(). needs: what its hosts must have.
    """

    def register(function: _Function) -> _Function:
        definition = _function("host_sync", name, function, parameters, "host, settings")
        definition["needs"] = list(needs)
        can_exchange = server is None

        def follow(port: Any, settings: Dict[str, Any], _client: Optional[int]) -> Any:
            return function(Host(port, can_exchange), types.SimpleNamespace(**settings))

        definition["make"] = follow
        definition["server"] = None
        if server is not None:
            answers = server
            serving = _function("host_sync", name, server, parameters, "host, client, settings")

            def serve(port: Any, settings: Dict[str, Any], client: Optional[int]) -> Any:
                return answers(Host(port, False), client, types.SimpleNamespace(**settings))

            serving["make"] = serve
            definition["server"] = serving
        _simbench.register_host_sync(definition)
        setattr(function, "simbench_name", name)
        return function

    return register


def capture_alignment(name: str, *, needs: Sequence[str] = (),
                      **parameters: Any) -> Callable[[_Function], _Function]:
    """Registers an `async def function(host, camera, settings)` that steers a camera's exposures.

    One runs for each camera, on its host, from the start of the cameras until the capture ends; it
    may return before. Datagrams between master and slaves are those of this stage alone.

    name, parameters: as for device_time(). needs: what its hosts must have besides frame_control.
    """

    def register(function: _Function) -> _Function:
        definition = _function("capture_alignment", name, function, parameters,
                               "host, camera, settings")
        definition["needs"] = ["frame_control", *needs]

        def steer(port: Any, settings: Dict[str, Any], place: int) -> Any:
            return function(Host(port, False), Camera(port, place),
                            types.SimpleNamespace(**settings))

        definition["make"] = steer
        _simbench.register_capture_alignment(definition)
        setattr(function, "simbench_name", name)
        return function

    return register


def _function(stage: str, name: str, function: Callable[..., Any], parameters: Dict[str, Any],
              shape: str) -> Dict[str, Any]:
    kind = "async def"
    if not inspect.iscoroutinefunction(function):
        raise TypeError(f"{stage} {name}: found {function!r}, allowed: an async def function")
    _check_call(function, f"{kind} {function.__name__}", function,
                f"{function.__name__}({shape})", [None] * len(shape.split(",")))
    return _definition(name, function, kind, function, parameters)


def pipeline(name: str, *, base: Optional[str] = None, host_sync: Any = None,
             capture_alignment: Any = None, device_time: Any = None,
             gathering: Any = None) -> Pipeline:
    """A row of its own name: the base pipeline with these stages in place of its own.

    A stage (host_sync, capture_alignment, device_time, gathering) is the name of an algorithm, or a
    class or function that is decorated; a capture_alignment of "" is none. Without `base` the
    scenario's first pipeline is the base. name: that of the row.
    """

    def name_of(stage: Any) -> Optional[str]:
        if stage is None or isinstance(stage, str):
            return stage
        found: Optional[str] = getattr(stage, "simbench_name", None)
        if found is None:
            raise TypeError(f"pipeline {name}: found {stage!r}, allowed: the name of an algorithm, "
                            "or a class or function that is decorated")
        return found

    return Pipeline(name, base, name_of(host_sync), name_of(capture_alignment),
                    name_of(device_time), name_of(gathering))
