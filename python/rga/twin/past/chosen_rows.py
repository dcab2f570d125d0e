"""Rows of a long past that stand for all: about its marks, over its contexts, the latest, evenly.

Rows are chosen in runs on end: the memory of the noise shows in neighbours alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray

#: rows of a run: three of four then follow the one before, and show the memory of the noise; more
#: of them would say little more, where the noise has one
ON_END = 4
#: shares of the runs: of a zero (at most), about marks, over contexts, the latest, the calibration;
#: the rest is even in time
ZERO, ABOUT_MARKS, OVER_CONTEXTS, LATEST, CALIBRATION = 0.2, 0.3, 0.25, 0.15, 0.1
#: runs that a mark is given at least; the latest marks go first
LEAST = 8


@dataclass(frozen=True)
class ChosenRows:
    """Rows of a past.

    Attributes:
        rows: int[n], ascending.
        words: how they were chosen; empty where they are all rows.
    """

    rows: IntArray
    words: str


def chosen_rows(
    rows: int,
    contexts: FloatArray,
    ranges: FloatArray,
    marks: Sequence[int],
    calibrated: int,
    most: int,
    seed: int,
    *,
    zero: IntArray | None = None,
    gone: BoolArray | None = None,
    on_end: int = ON_END,
) -> ChosenRows:
    """Choose rows of a past: all, or at most a number.

    All rows next to a mark are there, and ever fewer farther away, so that what began at it can be
    dated. Conditions count by whether they occurred, not by how often: rare values of a context
    have the same share as usual ones, before the last mark and since.

    Args:
        rows: of the past.
        contexts: float[rows, k] in their units, NaN where unknown.
        ranges: of the contexts, float[k, 2].
        marks: rows at which something may have begun.
        calibrated: rows of the first calibration.
        most: rows that may be chosen.
        seed: of the choice among rows under the same conditions.
        zero: rows whose mean was taken off the channels, int[m]; None: there are none.
        gone: rows that cannot be chosen, bool[rows]; None: none. The first can be.
        on_end: rows of a run.

    >>> warmth = np.linspace(0.0, 30.0, 1000)[:, None]
    >>> choice = chosen_rows(1000, warmth, np.array([[0.0, 30.0]]), [950], 100, 80, seed=0)
    >>> print(choice.words.replace(": ", ", ").replace(", ", chr(10)))
    80 of 1 000 rows
    4 on end
    16 about row 950
    16 over the contexts
    12 the latest
    8 of the calibration
    28 evenly over time
    >>> set(range(948, 952)) <= set(choice.rows.tolist())
    True
    >>> chosen_rows(1000, warmth, np.array([[0.0, 30.0]]), [950], 100, 1000, seed=0).words
    ''
    """
    gone = np.zeros(rows, dtype=bool) if gone is None else gone
    if np.count_nonzero(~gone) <= most:
        return ChosenRows(np.flatnonzero(~gone), "")
    on_end = min(on_end, most)
    runs = _Runs(np.logical_or.reduceat(gone, np.arange(0, rows, on_end)), most // on_end)
    # What counts from the first row needs it.
    runs.take(np.zeros(1, dtype=np.int64), 1)
    told = []

    def tell(number: int, words: str) -> None:
        if number:
            told.append(f"{_number(number * on_end)} {words}")

    if zero is not None and len(zero):
        taken = runs.take_evenly(np.unique(zero // on_end), runs.share(ZERO))
        tell(taken, "of the zero")
    inside = sorted({mark for mark in marks if 0 < mark < rows})
    about = inside[-max(1, runs.share(ABOUT_MARKS) // LEAST) :]
    taken = sum(
        runs.take_about(mark, on_end, runs.share(ABOUT_MARKS) // len(about)) for mark in about
    )
    tell(taken, f"about row{'s' * (len(about) > 1)} {', '.join(map(_number, about))}")
    every, draw = np.arange(runs.count), np.random.default_rng(seed)
    last = (about[-1] if about else calibrated) // on_end
    each = runs.share(OVER_CONTEXTS) // 2 // max(contexts.shape[1], 1)
    taken = 0
    for column, bounds in zip(contexts[::on_end].T, ranges, strict=True):
        for part in (every[:last], every[last:]):
            cells = _cells(column[part], bounds, each)
            taken += runs.take(part[_by_turns(cells, draw)], each)
    tell(taken, "over the contexts")
    tell(runs.take(every[::-1], runs.share(LATEST)), "the latest")
    calibration = every[: calibrated // on_end]
    tell(runs.take_evenly(calibration, runs.share(CALIBRATION)), "of the calibration")
    tell(runs.take_evenly(every, runs.left) + 1, "evenly over time")
    chosen = runs.rows(rows, on_end)
    words = f"{_number(len(chosen))} of {_number(rows)} rows, {on_end} on end: {', '.join(told)}"
    return ChosenRows(chosen, words)


class _Runs:
    """Runs of rows that follow one another, and which are taken.

    Args:
        gone: those that cannot be taken, bool[runs].
        most: how many may be taken.
    """

    def __init__(self, gone: BoolArray, most: int) -> None:
        self.count, self.most = len(gone), most
        self._free: BoolArray = ~gone
        self._taken: BoolArray = np.zeros(len(gone), dtype=bool)

    @property
    def left(self) -> int:
        """How many may still be taken."""
        return self.most - int(self._taken.sum())

    def share(self, of_most: float) -> int:
        """How many a share of those are that may be taken."""
        return int(of_most * self.most)

    def take(self, wanted: IntArray, number: int) -> int:
        """Take the first of some that are not yet taken; how many these were."""
        free = wanted[self._free[wanted]][: min(number, self.left)]
        self._free[free], self._taken[free] = False, True
        return len(free)

    def take_evenly(self, wanted: IntArray, number: int) -> int:
        """Take some that are not yet taken, evenly; how many these were."""
        free = wanted[self._free[wanted]]
        number = min(number, self.left, len(free))
        middle = (2 * np.arange(number) + 1) * len(free) // max(2 * number, 1)
        return self.take(free[middle], number)

    def take_about(self, mark: int, on_end: int, number: int) -> int:
        """Take those about a row, as many before it as after it; how many these were."""
        before, after = (mark - 1) // on_end, mark // on_end
        sides = (
            before - _distances(number // 2, before),
            after + _distances(number - number // 2, self.count - 1 - after),
        )
        return sum(self.take(side, number) for side in sides)

    def rows(self, rows: int, on_end: int) -> IntArray:
        """The rows of those that are taken, ascending."""
        # The last run ends with the last row, and may begin within the one before.
        first = np.minimum(np.flatnonzero(self._taken) * on_end, rows - on_end)
        return np.unique(first[:, None] + np.arange(on_end))


def _distances(number: int, reach: int) -> IntArray:
    """Distances up to a reach: half of them without a gap, half ever farther apart.

    >>> _distances(10, 1000)
    array([   0,    1,    2,    3,    4,    5,   20,   76,  277, 1000])
    """
    near = number // 2
    far = np.geomspace(near + 1, max(near, reach) + 1, number - near).astype(int) - 1
    order = np.arange(number)
    distances = np.maximum.accumulate(np.concatenate([order[:near], far]) - order) + order
    return np.asarray(distances[distances <= reach])


def _cells(values: FloatArray, bounds: FloatArray, number: int) -> IntArray:
    """Numbers of equal cells in which values lie, within bounds, and of one for what is unknown.

    >>> _cells(np.array([1.0, 2.0, 9.0, 999.0, np.nan]), np.array([0.0, 10.0]), 3)
    array([ 0,  0,  2,  2, -1])
    """
    known = np.isfinite(values)
    inside = np.clip(values[known], *bounds)
    cells = np.full(len(values), -1)
    low = inside.min(initial=bounds[1])
    width = inside.max(initial=bounds[0]) - low
    cells[known] = np.minimum((inside - low) / (width or 1.0) * number, number - 1)
    return cells


def _by_turns(cells: IntArray, draw: np.random.Generator) -> IntArray:
    """An order by chance in which all cells have their turn before one has another; int[cells].

    >>> cells = np.array([0, 0, 0, 0, 0, 0, 1, 2])
    >>> sorted(cells[_by_turns(cells, np.random.default_rng(0))][:3].tolist())
    [0, 1, 2]
    """
    shuffled = draw.permutation(len(cells))
    by_cell = shuffled[np.argsort(cells[shuffled], kind="stable")]
    own = cells[by_cell]
    turn = np.arange(len(own)) - np.searchsorted(own, own)
    return np.asarray(by_cell[np.lexsort((draw.random(len(own)), turn))])


def _number(value: int) -> str:
    return f"{value:,}".replace(",", " ")
