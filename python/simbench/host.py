"""The host of an algorithm in Python: its clocks, its network, and the cameras that it may steer.

An `async def` function that @simbench.host_sync or @simbench.capture_alignment decorates gets a
Host. What takes time on a real host is awaited and takes time in the simulator too. Times are whole
nanoseconds; timeouts and sleeps are milliseconds.

    @simbench.host_sync("cristian", questions=16)
    async def cristian(host, settings):
        replies = [await host.channel(0).exchange(timeout_ms=100) for _ in range(settings.questions)]
        best = min((r for r in replies if r), key=lambda r: r.delay_ns)
        await host.clock.step(best.offset_ns)
"""

import types
from typing import Any, FrozenSet, Generator, NamedTuple, Optional, Tuple

_NEVER_MS = 365 * 86400e3


class Message(NamedTuple):
    """A message as Channel.receive() returns it."""

    bytes: bytes
    received_ns: int  # on the system clock, from the point of the stack that stamps
    received_steady_ns: int
    received_hardware_ns: Optional[int]  # of the network card, if it stamps


class Reply(NamedTuple):
    """An exchange with the master, as Channel.exchange() returns it.

    The question left at t1 and its answer came at t4, on the own system clock; the master had the
    question at t2 and sent its answer at t3, on the master's.
    """

    bytes: bytes  # those of the question
    t1_ns: int
    t2_ns: int
    t3_ns: int
    t4_ns: int

    @property
    def offset_ns(self) -> int:
        """The master's clock less the own, if both ways took the same time."""
        return ((self.t2_ns - self.t1_ns) + (self.t3_ns - self.t4_ns)) // 2

    @property
    def delay_ns(self) -> int:
        """Both ways together."""
        return (self.t4_ns - self.t1_ns) - (self.t3_ns - self.t2_ns)


class CrossStamp(NamedTuple):
    """The network card's clock between two readings of the system clock."""

    before_ns: int
    hardware_ns: int
    after_ns: int


@types.coroutine
def _ask(*request: Any) -> Generator[Any, Any, Any]:
    """Asks the world; what it answers is of the kind that the request names."""
    return (yield request)


def _ns(ms: float) -> int:
    return round(ms * 1e6)


class Clock:
    """The system clock of a host."""

    async def now(self) -> int:
        """Its reading."""
        answer: int = await _ask("now")
        return answer

    async def set(self, time_ns: float) -> None:
        """Sets it."""
        await _ask("set", round(time_ns))

    async def step(self, offset_ns: float) -> None:
        """Reads it and sets it later by the offset."""
        await _ask("step", round(offset_ns))

    async def adjust_frequency(self, ppb: float) -> None:
        """Its rate against the oscillator, in place of the former one."""
        await _ask("adjust_frequency", float(ppb))

    async def slew(self, offset_ns: float, max_rate_ppb: float = 500_000) -> None:
        """Adds the offset gradually, in place of an unfinished slew."""
        await _ask("slew", round(offset_ns), float(max_rate_ppb))


class NetworkCard:
    """The clock of the network card."""

    async def cross_stamp(self) -> CrossStamp:
        """Reads it between two readings of the system clock."""
        answer: CrossStamp = await _ask("cross_stamp")
        return answer

    async def step(self, offset_ns: float) -> None:
        """Adds the offset at once."""
        await _ask("step_card", round(offset_ns))

    async def adjust_frequency(self, ppb: float) -> None:
        """Its rate against its own oscillator."""
        await _ask("adjust_card", float(ppb))


class Channel:
    """Messages to and from one host: datagrams, which may be lost, or a stream."""

    __slots__ = ("_at", "_can_exchange")

    def __init__(self, peer: int, stream: bool, can_exchange: bool) -> None:
        self._at = (peer, stream)
        self._can_exchange = can_exchange

    async def send(self, message: bytes) -> int:
        """Sends it and returns its number, for transmit_stamp()."""
        answer: int = await _ask("send", *self._at, bytes(message))
        return answer

    async def receive(self, timeout_ms: float = _NEVER_MS) -> Optional[Message]:
        """The next message, or None after the timeout."""
        answer: Optional[Message] = await _ask("receive", *self._at, _ns(timeout_ms))
        return answer

    async def exchange(self, message: bytes = b"", timeout_ms: float = 1000) -> Optional[Reply]:
        """Asks the master for its time. None if no answer comes in time.

        Late and duplicated answers are ignored, and the exchange is in the recording.
        """
        if not self._can_exchange:
            raise TypeError("exchange() asks the master's own answerer, which runs only where "
                            "host_sync has no server=; use send() and receive()")
        answer: Optional[Reply] = await _ask("exchange", *self._at, bytes(message), _ns(timeout_ms))
        return answer

    async def transmit_stamp(self, message: int, timeout_ms: float = 10) -> Optional[int]:
        """When that message left, if the host stamps."""
        answer: Optional[int] = await _ask("transmit_stamp", *self._at, message, _ns(timeout_ms))
        return answer

    async def hardware_transmit_stamp(self, message: int, timeout_ms: float = 10) -> Optional[int]:
        """When it passed the network card, on the card's clock, if that stamps."""
        answer: Optional[int] = await _ask("hardware_transmit_stamp", *self._at, message, _ns(timeout_ms))
        return answer


class Host:
    """A host of the rig: 0 is the master, the others are its slaves."""

    def __init__(self, port: Any, can_exchange: bool) -> None:
        self._port = port
        self._can_exchange = can_exchange
        self.id: int = port.id
        self.clock = Clock()
        self.card: Optional[NetworkCard] = NetworkCard() if port.has_card() else None

    def channel(self, peer: int, stream: bool = False) -> Channel:
        """The channel to a host: of a slave to the master, 0; of the master to a slave."""
        return Channel(peer, stream, self._can_exchange)

    async def sleep_for(self, interval_ms: float) -> None:
        """Waits on the steady clock."""
        await _ask("sleep_for", _ns(interval_ms))

    async def sleep_until(self, at_ns: float) -> None:
        """Waits until the system clock reads that, also where it is set meanwhile."""
        await _ask("sleep_until", round(at_ns))

    @property
    def steady_ns(self) -> int:
        """The host's oscillator, which nothing sets. Reading it costs nothing."""
        answer: int = self._port.steady_ns()
        return answer

    def random(self) -> float:
        """A number from 0 to 1, the same in every run of a seed, as those of Python are not."""
        answer: float = self._port.random()
        return answer

    @property
    def stored_frequency(self) -> Optional[Tuple[float, float]]:
        """(ppb, its likely error) of the clock service's last run, or None."""
        answer: Optional[Tuple[float, float]] = self._port.stored_frequency()
        return answer

    def failed(self, why: str) -> None:
        """Reports that the clock could not be synchronised, and what would help."""
        self._port.failed(why)

    def report_delays(self, t_l_ns: float, t_t_ns: float, t_d_ns: float, get_ns: float = 0,
                      set_ns: float = 0, pass_number: int = 1,
                      begin_steady_ns: Optional[int] = None,
                      end_steady_ns: Optional[int] = None) -> None:
        """Reports what a slave measured in a pass of its session, and added: as yoon2021 does.

        t_l: network delay, t_t: time delay, t_d: what was added to the master's time; get and set:
        what a reading and a setting of the clock took. The pass began and ended now, unless stated.
        The last pass of a session is the one that counts in results.
        """
        now = self.steady_ns
        begin = now if begin_steady_ns is None else begin_steady_ns
        end = now if end_steady_ns is None else end_steady_ns
        self._port.report_delays(pass_number, [begin, end] + [
            round(ns) for ns in (t_l_ns, t_t_ns, t_d_ns, get_ns, set_ns)])


class Exposure(NamedTuple):
    """A frame of a camera as Camera.next_frame() returns it."""

    number: int  # the camera's frame counter
    exposed_ns: int  # middle of the exposure on the host's system clock, as well as it knows it
    exposed_steady_ns: int  # the same on its steady clock
    arrival_ns: int
    arrival_steady_ns: int
    exposure_ns: int
    settled: bool  # False: it may not show yet what the last control did


class Camera:
    """A camera of the host, whose exposures a capture_alignment steers by the frames' lengths.

    A control returns whether the camera accepted it; what it refuses is reported with the reason.
    It acts `latency_frames` frames later or more, may be lost, and is rounded to `granularity_ns`.
    """

    def __init__(self, port: Any, place: int) -> None:
        self._port = port
        self._place = place
        facts = port.camera(place)
        self.number: int = facts["number"]  # on the rig
        self.frame_length_ns: int = facts["frame_length_ns"]  # the usual one
        self.shortest_ns: int = facts["shortest_ns"]  # that fits the exposure
        self.longest_ns: int = facts["longest_ns"]
        self.granularity_ns: int = facts["granularity_ns"]
        self.latency_frames: int = facts["latency_frames"]
        #: Those of adjust_frame, insert_frame, frame_length, start_at that the camera has.
        self.controls: FrozenSet[str] = frozenset(facts["controls"])

    async def next_frame(self) -> Exposure:
        """Waits for it, however long."""
        answer: Exposure = await _ask("next_frame", self._place)
        return answer

    async def adjust_frame(self, by_ns: float) -> bool:
        """One frame is longer by this, or shorter if it is negative."""
        answer: bool = await _ask("adjust_frame", self._place, round(by_ns))
        return answer

    async def insert_frame(self, length_ns: float) -> bool:
        """One frame of that length, with an exposure as long as that allows."""
        answer: bool = await _ask("insert_frame", self._place, round(length_ns))
        return answer

    async def set_frame_length(self, length_ns: float) -> bool:
        """All frames from now on."""
        answer: bool = await _ask("frame_length", self._place, round(length_ns))
        return answer

    async def start_at(self, at_ns: float) -> bool:
        """Stops the camera; its next exposure begins when the system clock reads that."""
        answer: bool = await _ask("start_at", self._place, round(at_ns))
        return answer

    def report(self, aligned: bool, message: str = "") -> None:
        """What the algorithm thinks it has reached; the message says what would help."""
        self._port.report(self._place, aligned, message)
