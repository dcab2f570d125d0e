"""Whether the clock of a logger can be believed."""

from collections import OrderedDict
from dataclasses import dataclass
from threading import Lock
from typing import NamedTuple

from rga.operation.packets.packet import MICROSECONDS, Number

MINUTE, DAY = 60.0, 86_400.0
#: how long a clock may stand still, or run behind what it has shown, before that is no disorder of
#: packets on their way [s]
STILL = 60.0
#: streams whose clocks are remembered
MOST_STREAMS = 10_000
_OLD = "it was away, or its clock is behind"


@dataclass(frozen=True)
class ClockRule:
    """What is believed of a logger's clock.

    Attributes:
        tolerance: by which it may be ahead of the clock of this machine [s].
        backlog: how long before they arrive readings may be from [s]: a logger sends what it kept
            while the network was away.
    """

    tolerance: float = 30 * MINUTE
    backlog: float = 7 * DAY

    def fault(self, first: int, last: int, arrived: int) -> str | None:
        """Why readings cannot be from these moments [µs since 1970]; None: they can.

        >>> ClockRule().fault(0, 0, 1_000_000)
        >>> ClockRule().fault(7_200_000_000, 7_200_000_000, 0)
        'its clock is 2 h ahead'
        """
        ahead = (last - arrived) / MICROSECONDS
        if ahead > self.tolerance:
            return f"its clock is {in_words(ahead)} ahead"
        behind = (arrived - first) / MICROSECONDS
        if behind > self.backlog:
            return f"its readings are {in_words(behind)} old"
        return None


@dataclass
class _Stream:
    """The latest that was believed: its moment and arrival [µs since 1970], and its number."""

    moment: int
    arrived: int
    sequence: int


class _Fault(NamedTuple):
    """What is wrong with a clock: of which kind, in words, and when it was seen last [µs]."""

    kind: str
    words: str
    seen: int


class ClockWatch:
    """Follows the clocks of the loggers of one source.

    Readings may be old: what a logger kept while the network was away goes on where it stopped.
    A clock that has run back shows times that it has shown before; they are not believed, so that
    nothing is doubled, until it is past them. The first that comes of a logger is believed, as
    nobody knows what came before.

    Args:
        rule: what is believed.
    """

    def __init__(self, rule: ClockRule) -> None:
        self._rule = rule
        self._streams: OrderedDict[str, _Stream] = OrderedDict()
        self._faults: dict[str, _Fault] = {}
        self._lock = Lock()

    @property
    def fault(self) -> str | None:
        """What is wrong with clocks, the same however many packets show it; None: nothing."""
        with self._lock:
            faults = list(self._faults.items())
        if not faults:
            return None
        logger, first = faults[0]
        more = f", and {len(faults) - 1} more of the loggers" if len(faults) > 1 else ""
        return f"{logger}: {first.words}{more}"

    def refused(
        self, place: str, number: Number | None, first: int, last: int, arrived: int
    ) -> str | None:
        """Why readings are not believed; None: they are.

        Args:
            place: that they came from.
            number: of their packet.
            first, last: moments of the readings, microseconds since 1970 (UTC).
            arrived: microseconds since 1970 (UTC).

        >>> watch, hour = ClockWatch(ClockRule()), 3_600_000_000
        >>> watch.refused("a", Number("s", 0), 5 * hour, 5 * hour, 5 * hour)
        >>> watch.refused("a", Number("s", 1), 3 * hour, 3 * hour, 5 * hour)
        'its clock has run back by 2 h'
        """
        name = place if number is None else number.stream
        with self._lock:
            kind, reason = "off", self._rule.fault(first, last, arrived)
            if reason is None:
                kind, reason = "back", self._run_back(name, number, last, arrived)
            told, old = reason, (arrived - last) / MICROSECONDS
            if told is None and old > self._rule.tolerance:
                kind, told = "old", f"its readings are {in_words(old)} old: {_OLD}"
            self._tell(place, kind, told, arrived)
        return reason

    def _run_back(self, name: str, number: Number | None, last: int, arrived: int) -> str | None:
        known = self._streams.get(name)
        sequence = -1 if number is None else number.sequence
        if known is None:
            if len(self._streams) >= MOST_STREAMS:
                self._streams.popitem(last=False)
            self._streams[name] = _Stream(last, arrived, sequence)
            return None
        self._streams.move_to_end(name)
        if number is not None and sequence <= known.sequence:
            # It fills a gap, or came before.
            return None
        if last > known.moment:
            self._streams[name] = _Stream(last, arrived, sequence)
            return None
        back = (known.moment - last) / MICROSECONDS
        waited = (arrived - known.arrived) / MICROSECONDS
        if waited > STILL or (number is not None and back > self._rule.tolerance):
            known.sequence = sequence
            return f"its clock has run back by {in_words(back)}" if back else "its clock stands"
        known.sequence = sequence
        return None

    def _tell(self, place: str, kind: str, words: str | None, arrived: int) -> None:
        """Tell what is wrong in the words in which it was first told."""
        before = self._faults.pop(place, None)
        while self._faults and (oldest := next(iter(self._faults))):
            if arrived - self._faults[oldest].seen <= self._rule.tolerance * MICROSECONDS:
                break
            del self._faults[oldest]
        if words is not None and len(self._faults) < MOST_STREAMS:
            same = before is not None and before.kind == kind
            said = before.words if before is not None and same else words
            self._faults[place] = _Fault(kind, said, arrived)


def in_words(seconds: float) -> str:
    """A span of time in the unit in which it is read best.

    >>> in_words(90), in_words(7200), in_words(86_400 * 3)
    ('90 s', '2 h', '3 days')
    """
    for unit, size in (("days", DAY), ("h", 3600.0), ("min", MINUTE)):
        if seconds >= 2 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"
