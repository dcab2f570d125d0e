"""How far a table was read whose rows may become visible late."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Any

Position = int | float | datetime


@dataclass(frozen=True)
class TablePlace:
    """How far a table was read.

    Attributes:
        floor: below which all rows have come; None: none is known to have.
        passed: the highest that has come; None: none has.
        waits: place to which the floor rises when all transactions below the fence are over.
        fence: transaction that was to come next when `waits` was passed; None: none is waited for.
        taken: marks of rows that have come and are looked for again, with their positions.
    """

    floor: Position | None = None
    passed: Position | None = None
    waits: Position | None = None
    fence: int | None = None
    taken: Mapping[str, Position] = field(default_factory=dict)

    def moved(
        self,
        passed: Position | None,
        taken: Mapping[str, Position],
        oldest: int | None,
        following: int | None,
    ) -> "TablePlace":
        """The place when more rows have come, all that were visible up to the highest of them.

        Args:
            passed: the highest that has come.
            taken: marks of those that have come.
            oldest: transaction that is still under way, or the next; None: nobody can tell.
            following: transaction that comes next.

        >>> place = TablePlace().moved(7, {}, oldest=3, following=5)
        >>> place.floor, place.moved(9, {}, 4, 6).floor, place.moved(9, {}, 5, 6).floor
        (None, None, 7)
        """
        if oldest is None:
            return replace(self, floor=passed, passed=passed, taken=taken)
        floor, waits, fence = self.floor, self.waits, self.fence
        if fence is None or oldest >= fence:
            # All that could still become visible below has done so, and has come.
            floor, waits, fence = (floor if fence is None else waits), passed, following
        if floor == passed:
            waits = fence = None
        return TablePlace(floor, passed, waits, fence, taken)

    def pruned(self, overlap: float) -> "TablePlace":
        """The same without the marks of rows that are not looked for again."""
        if self.floor is None:
            return self
        least = behind(self.floor, overlap)
        kept = {mark: at for mark, at in self.taken.items() if at >= least}  # type: ignore[operator]
        return replace(self, taken=kept)

    def to_json(self) -> dict[str, Any]:
        """As JSON says it."""
        return {
            "floor": _said(self.floor),
            "passed": _said(self.passed),
            "waits": _said(self.waits),
            "fence": self.fence,
            "taken": {mark: _said(at) for mark, at in self.taken.items()},
        }

    @classmethod
    def from_json(cls, said: Mapping[str, Any] | None) -> "TablePlace":
        """The place that JSON says; None: nothing was read."""
        if said is None:
            return cls()
        floor, passed, waits = (_read(said[one]) for one in ("floor", "passed", "waits"))
        taken = {mark: _read(at) for mark, at in said["taken"].items()}
        return cls(floor, passed, waits, said["fence"], taken)


def behind(position: Position, overlap: float) -> Position:
    """The place that lies behind another: by a number, or by seconds where places are times.

    >>> behind(100, 60.0)
    40
    """
    if isinstance(position, datetime):
        return position - timedelta(seconds=overlap)
    return position - type(position)(overlap)


def mark_of(values: Iterable[Any]) -> str:
    """By which a row is known again."""
    return sha256(repr(tuple(values)).encode()).hexdigest()[:24]


def _said(position: Position | None) -> Any:
    return position.isoformat() if isinstance(position, datetime) else position


def _read(said: Any) -> Any:
    return datetime.fromisoformat(said) if isinstance(said, str) else said
