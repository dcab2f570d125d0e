"""T1: is the twin in sync with the structure?"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from rga.arrays import FloatArray

SHOWN = 4
#: residuals of rows from one to another, float[rows, channels], NaN where missing
Residuals: TypeAlias = Callable[[int, int], FloatArray]


@dataclass(frozen=True)
class OutOfSync:
    """The twin is out of sync.

    Attributes:
        row: at which it was found.
        since: first row that it is about.
        sensors: that show it.
        words: what was found.
    """

    row: int
    since: int
    sensors: tuple[str, ...]
    words: str


class Synchrony(Protocol):
    """Watches the residuals of a calibrated twin: measured minus simulated."""

    def alarm(self, first: int, end: int, residuals: Residuals) -> OutOfSync | None:
        """The first alarm that the latest rows raise.

        Args:
            first, end: of these rows.
            residuals: of rows so far.
        """

    def begin_again(self, first: int | None, end: int, residuals: Residuals) -> None:
        """Learn what a newly calibrated twin leaves.

        Args:
            first: of the rows that say what is usual; None: still the same.
            end: rows so far.
            residuals: of these.
        """

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons why alarms may come without a change."""

    def to_bytes(self) -> bytes:
        """The state."""

    def restore(self, state: bytes) -> None:
        """Go on where another stood."""


def listed(sensors: Sequence[str]) -> str:
    """The first names, and how many more."""
    more = f" and {len(sensors) - SHOWN} more" if len(sensors) > SHOWN else ""
    return f"{', '.join(sensors[:SHOWN])}{more}"
