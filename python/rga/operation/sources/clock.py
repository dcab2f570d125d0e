"""Whether the clock of a logger can be believed."""

from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass
from typing import NamedTuple

from rga.operation.packets.packet import MICROSECONDS, Number

MINUTE, DAY = 60.0, 86_400.0
#: days beyond which a span is told in years
MANY_DAYS = 2000.0
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


class ClockSight(NamedTuple):
    """What readings show of a clock.

    Attributes:
        place: that they came from.
        channels: that they are of.
        number: of their packet; None: it has none.
        first, last: moments of the readings, microseconds since 1970 (UTC).
        arrived: microseconds since 1970 (UTC).
    """

    place: str
    channels: frozenset[str]
    number: Number | None
    first: int
    last: int
    arrived: int

    @property
    def logger(self) -> Hashable:
        """By which a logger is known again: its stream, else where it sends what."""
        return (self.place, self.channels) if self.number is None else self.number.stream


class _Shown(NamedTuple):
    """The latest that a clock has shown: its moment and arrival [µs since 1970], and number."""

    moment: int
    arrived: int
    sequence: int


class _Fault(NamedTuple):
    """What is wrong with a clock: whose, of which kind, in words, when it was seen last [µs]."""

    place: str
    kind: str
    words: str
    seen: int


class ClockWatch:
    """Follows the clocks of the loggers of one source.

    Readings may be old: what a logger kept while the network was away goes on where it stopped.
    A clock that has run back, or stands, shows times that it has shown before; they are not
    believed, so that nothing is doubled, until it is past them. The first that comes of a logger
    is believed, as nobody knows what came before.

    Args:
        rule: what is believed.
        disorder: by which readings may come after others of later times [s], before that is a
            clock that has run back.
    """

    def __init__(self, rule: ClockRule, disorder: float = MINUTE) -> None:
        self._rule, self._disorder = rule, disorder
        self._shown: OrderedDict[Hashable, _Shown] = OrderedDict()
        self._before: dict[Hashable, _Shown | None] = {}
        self._faults: dict[Hashable, _Fault] = {}

    @property
    def fault(self) -> str | None:
        """What is wrong with clocks, the same however many packets show it; None: nothing."""
        faults = list(self._faults.values())
        if not faults:
            return None
        first, more = faults[0], len(faults) - 1
        return f"{first.place}: {first.words}{f', and {more} more of the loggers' * bool(more)}"

    def refused(self, sight: ClockSight) -> str | None:
        """Why readings are not believed; None: they are.

        >>> watch, hour, channels = ClockWatch(ClockRule()), 3_600_000_000, frozenset(["D1"])
        >>> for number, time in enumerate((5 * hour, 3 * hour)):
        ...     sight = ClockSight("a", channels, Number("s", number), time, time, 5 * hour)
        ...     print(watch.refused(sight))
        None
        its clock has run back by 2 h
        """
        kind, reason = "off", self._rule.fault(sight.first, sight.last, sight.arrived)
        if reason is None:
            kind, reason = "back", self._run_back(sight)
        told, old = reason, (sight.arrived - sight.last) / MICROSECONDS
        if told is None and old > self._rule.tolerance:
            kind, told = "old", f"its readings are {in_words(old)} old: {_OLD}"
        self._tell(sight, kind, told)
        return reason

    def keep(self) -> None:
        """What was seen since the last call is kept."""
        self._before.clear()

    def undo(self) -> None:
        """What was seen since the last call is not kept, and comes again."""
        for logger, shown in self._before.items():
            self._shown.pop(logger, None)
            if shown is not None:
                self._shown[logger] = shown
        self._before.clear()

    def _run_back(self, sight: ClockSight) -> str | None:
        logger, reason = sight.logger, None
        known = self._shown.get(logger)
        sequence = -1 if sight.number is None else sight.number.sequence
        now = _Shown(sight.last, sight.arrived, sequence)
        if known is not None:
            if sight.number is not None and now.sequence <= known.sequence:
                # It fills a gap, or came before.
                return None
            back = (known.moment - now.moment) / MICROSECONDS
            if back >= 0:
                waited = (now.arrived - known.arrived) / MICROSECONDS
                jumped = sight.number is not None and back > self._rule.tolerance
                if jumped or waited > self._disorder:
                    reason = f"has run back by {in_words(back)}" if back else "stands"
                now = known._replace(sequence=now.sequence)
        self._before.setdefault(logger, known)
        self._shown[logger] = now
        self._shown.move_to_end(logger)
        if len(self._shown) > MOST_STREAMS:
            self._shown.popitem(last=False)
        return None if reason is None else f"its clock {reason}"

    def _tell(self, sight: ClockSight, kind: str, words: str | None) -> None:
        """Tell what is wrong in the words in which it was first told, as long as it is seen."""
        faults, longest = self._faults, self._rule.tolerance * MICROSECONDS
        before = faults.get(sight.logger)
        faults = {
            logger: one
            for logger, one in faults.items()
            if logger != sight.logger and sight.arrived - one.seen <= longest
        }
        if words is not None and len(faults) < MOST_STREAMS:
            said = before.words if before is not None and before.kind == kind else words
            faults[sight.logger] = _Fault(sight.place, kind, said, sight.arrived)
        self._faults = faults


def in_words(seconds: float) -> str:
    """A span of time in the unit in which it is read best.

    >>> in_words(90), in_words(7200), in_words(86_400 * 3), in_words(86_400 * 10_200)
    ('90 s', '2 h', '3 days', '27.9 years')
    """
    if seconds > MANY_DAYS * DAY:
        return f"{seconds / (365.25 * DAY):.3g} years"
    for unit, size in (("days", DAY), ("h", 3600.0), ("min", MINUTE)):
        if seconds >= 2 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"
