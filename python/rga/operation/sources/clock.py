"""Whether the clock of a logger can be believed."""

from dataclasses import dataclass

from rga.operation.packets.packet import MICROSECONDS

MINUTE, DAY = 60.0, 86_400.0
#: how the words begin that tell of a clock
_AHEAD, _BEHIND = "its clock is", "its readings are"


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
            return f"{_AHEAD} {in_words(ahead)} ahead"
        behind = (arrived - first) / MICROSECONDS
        if behind > self.backlog:
            return f"{_BEHIND} {in_words(behind)} old"
        return None


def tells_of_clock(reason: str) -> bool:
    """Whether a packet was refused for the clock of its logger.

    >>> tells_of_clock("its clock is 2 h ahead"), tells_of_clock("it is no packet")
    (True, False)
    """
    return reason.startswith((_AHEAD, _BEHIND))


def in_words(seconds: float) -> str:
    """A span of time in the unit in which it is read best.

    >>> in_words(90), in_words(7200), in_words(86_400 * 3)
    ('90 s', '2 h', '3 days')
    """
    for unit, size in (("days", DAY), ("h", 3600.0), ("min", MINUTE)):
        if seconds >= 2 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"
