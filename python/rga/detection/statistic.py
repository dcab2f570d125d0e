"""The statistics of the monitor: what kind and scale of change each is for."""

from dataclasses import dataclass
from typing import Literal

Where = Literal["one sensor", "all sensors alike", "all sensors", "several sensors"]


@dataclass(frozen=True)
class Statistic:
    """One of the statistics.

    Attributes:
        where: it looks for a change.
        what: change it is for, in words.
        share: of the false alarms that it may raise.
    """

    where: Where
    what: str
    share: float

    def __str__(self) -> str:
        return f"{self.what} in {self.where}"


def _group(where: Where, share: float, whats: list[str]) -> list[Statistic]:
    return [Statistic(where, what, share / len(whats)) for what in whats]


_STEPS = [f"a step of {size:g} standard deviations" for size in (0.25, 0.5, 1, 2, 4)]
_SPREADS = [f"noise {factor} times as large" for factor in ("1.4", "2", "0.5")]
_MEMORIES = [f"a change within the last {rows} rows" for rows in (2, 4, 8, 16, 32, 64, 128, 256)]

#: in the order of the core
STATISTICS = (
    *_group("one sensor", 0.45, _STEPS),
    *_group("one sensor", 0.08, _SPREADS),
    *_group("several sensors", 0.30, _MEMORIES),
    *_group("all sensors alike", 0.12, _STEPS[1:]),
    *_group("all sensors", 0.05, [f"{step} of the mean square" for step in _STEPS[1:]]),
)
