"""The latest rows of a run in memory; earlier ones are read where they are stored."""

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.twin.hardware.interface import Packet

#: rows that are kept at the least; all that were not followed yet are kept besides
KEPT = 1024


@dataclass(frozen=True)
class Stretch:
    """Rows that follow one another; NaN where nothing was measured, inferred or simulated.

    Attributes:
        time: seconds since the first row of the run, float[rows].
        readings: float[rows, channels].
        measured: measured contexts, float[rows, measured].
        told: the same with the last known value where one is missing, float[rows, measured];
            before the first known one NaN, or the middle of its range.
        contexts: all contexts, float[rows, contexts].
        spread: standard deviations of the contexts, float[rows, contexts].
        simulated: float[rows, channels].
    """

    time: FloatArray
    readings: FloatArray
    measured: FloatArray
    told: FloatArray
    contexts: FloatArray
    spread: FloatArray
    simulated: FloatArray

    def __len__(self) -> int:
        return len(self.time)

    def __getitem__(self, rows: slice) -> Self:
        return type(self)(*(getattr(self, one.name)[rows] for one in fields(self)))

    def followed_by(self, other: Self) -> Self:
        """These rows and then others."""
        return type(self)(
            *(
                np.concatenate([getattr(self, one.name), getattr(other, one.name)])
                for one in fields(self)
            )
        )

    @classmethod
    def empty(cls, rows: int, channels: int, measured: int, contexts: int) -> Self:
        """Rows of which nothing is known."""
        widths = (channels, measured, measured, contexts, contexts, channels)
        return cls(np.full(rows, np.nan), *(np.full((rows, width), np.nan) for width in widths))


class RecentRows:
    """The rows of a run: the latest in memory, at a cost that does not grow with the others.

    Args:
        channels, measured, contexts: how many channels, measured contexts and contexts there are.
        stored: rows from one to before another as they are stored, with what was inferred last.

    Attributes:
        stuck: channels that stand still: they have no residuals, bool[channels].
    """

    def __init__(
        self,
        channels: int,
        measured: int,
        contexts: int,
        stored: Callable[[int, int], Stretch],
    ) -> None:
        self._widths = channels, measured, contexts
        self._stored = stored
        self._table = Stretch.empty(2 * KEPT, *self._widths)
        self._first = self._end = self._followed = 0
        self.stuck: NDArray[np.bool_] = np.zeros(channels, dtype=np.bool_)

    def __len__(self) -> int:
        return self._end

    def take_up(self, rows: int, followed: int) -> None:
        """Go on behind rows that are stored.

        Args:
            rows: how many there are.
            followed: how many of them have contexts.
        """
        self._first = max(0, followed - KEPT)
        self._end, self._followed = rows, followed
        kept = self._stored(self._first, rows)
        self._table = kept.followed_by(Stretch.empty(max(0, 2 * KEPT - len(kept)), *self._widths))

    def leave_out(self, channels: Sequence[str], stuck: Container[str]) -> None:
        """Look no more at channels that stand still.

        Args:
            channels: names of all.
            stuck: names of these.
        """
        self.stuck = np.array([name in stuck for name in channels], dtype=np.bool_)

    def append(self, packet: Packet) -> None:
        """Add the rows of a packet."""
        self._make_room(len(packet.time))
        before = self._inside(max(self._first, self._end - 1), self._end).told
        first, self._end = self._end, self._end + len(packet.time)
        added = self._inside(first, self._end)
        added.time[:] = packet.time
        added.readings[:] = packet.readings
        added.measured[:] = packet.contexts
        added.told[:] = carried_on(before, packet.contexts)
        for table in (added.contexts, added.spread, added.simulated):
            table[:] = np.nan

    def followed(
        self, first: int, contexts: FloatArray, spread: FloatArray, simulated: FloatArray
    ) -> None:
        """Take over what was inferred and simulated from a row on, which is stored besides."""
        end = first + len(contexts)
        self._followed = max(self._followed, end)
        begin = max(first, self._first)
        if begin < end:
            kept = self._inside(begin, end)
            kept.contexts[:] = contexts[begin - first :]
            kept.spread[:] = spread[begin - first :]
            kept.simulated[:] = simulated[begin - first :]

    def forget(self, first: int, end: int) -> None:
        """Leave out readings of rows from one to before another, and what was simulated there."""
        begin = max(first, self._first)
        if begin < end:
            old = self._inside(begin, end)
            old.readings[:] = old.simulated[:] = np.nan

    def rows(self, first: int, end: int) -> Stretch:
        """Rows from one to before another; not to be written to."""
        if first >= self._first:
            return self._inside(first, end)
        early = self._stored(first, min(end, self._first))
        return early if end <= self._first else early.followed_by(self._inside(self._first, end))

    def residuals(self, first: int, end: int) -> FloatArray:
        """Measured minus simulated, float[end - first, channels]; NaN for stuck channels."""
        rows = self.rows(first, end)
        return np.where(self.stuck, np.nan, rows.readings - rows.simulated)

    def gaps(self, first: int, end: int) -> FloatArray:
        """Squares of the residuals, float[end - first, channels]."""
        return np.asarray(self.residuals(first, end) ** 2)

    def _inside(self, first: int, end: int) -> Stretch:
        return self._table[first - self._first : end - self._first]

    def _make_room(self, rows: int) -> None:
        """Forget followed rows, or make the tables larger, where rows do not fit behind them."""
        held, room = self._end - self._first, len(self._table)
        if held + rows <= room:
            return
        begin = max(self._first, min(self._followed, self._end) - KEPT)
        kept = self._inside(begin, self._end)
        needed = max(2 * KEPT, 2 * (len(kept) + rows))
        self._table = kept.followed_by(Stretch.empty(needed - len(kept), *self._widths))
        self._first = begin


def carried_on(before: FloatArray, values: FloatArray) -> FloatArray:
    """Values with the last known one where one is missing, of the shape of `values`.

    Args:
        before: what was known before them, float[0 or 1, columns].
        values: float[rows, columns], NaN where missing.
    """
    rows, columns = values.shape
    start = before if len(before) else np.full((1, columns), np.nan)
    table = np.concatenate([start, values])
    last = np.where(np.isfinite(values), np.arange(1, rows + 1)[:, None], 0)
    return np.take_along_axis(table, np.maximum.accumulate(last, axis=0), axis=0)
