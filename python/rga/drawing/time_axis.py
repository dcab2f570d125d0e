"""The time axis that figures of a record share: times as the record writes them."""

from dataclasses import dataclass
from datetime import datetime

import numpy as np
from matplotlib.axes import Axes
from matplotlib.dates import AutoDateLocator, ConciseDateFormatter, date2num
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.drawing.date_formats import BESIDE_DATES, DATES, ROUND_DATES
from rga.quantities import MINUS, duration
from rga.records import Record

Rows = NDArray[np.intp]
DAY = 86400.0


@dataclass(frozen=True)
class TimeAxis:
    """Where the rows of a record stand on an axis of time.

    Attributes:
        at: float[rows], increasing: days of the calendar, or time in the unit of the label.
        step: median distance of two rows on the same scale.
        label: of the axis.
        dates: whether `at` counts days of the calendar.
    """

    at: FloatArray
    step: float
    label: str
    dates: bool

    @property
    def ends(self) -> tuple[float, float]:
        """Left and right end: half a step before the first row and after the last."""
        return float(self.at[0] - self.step / 2), float(self.at[-1] + self.step / 2)

    def dress(self, axes: Axes, labelled: bool = True) -> None:
        """Set limits and ticks of an axis; without numbers and name where not labelled."""
        axes.set_xlim(*self.ends)
        if self.dates:
            locator = AutoDateLocator(minticks=4, maxticks=9)  # type: ignore[no-untyped-call]
            axes.xaxis.set_major_locator(locator)
            axes.xaxis.set_major_formatter(
                ConciseDateFormatter(  # type: ignore[no-untyped-call]
                    locator,
                    formats=DATES,
                    zero_formats=ROUND_DATES,
                    offset_formats=BESIDE_DATES,
                    show_offset=labelled,
                )
            )
        else:
            axes.xaxis.set_major_formatter(FuncFormatter(_plain))
        axes.tick_params(axis="x", labelbottom=labelled)
        if labelled:
            axes.set_xlabel(self.label)


def time_axis(record: Record) -> TimeAxis:
    """The axis of a record with at least one row."""
    steps = np.diff(record.time)
    step = float(np.median(steps)) if len(steps) else 1.0
    if isinstance(record.start, str):
        # The clock of the record is kept, whatever its time zone.
        clock = datetime.fromisoformat(record.start).replace(tzinfo=None)
        start = float(date2num(clock))  # type: ignore[no-untyped-call]
        return TimeAxis(start + record.time / DAY, step / DAY, "time of the record", True)
    span = float(record.time[-1] - record.time[0])
    length, unit = duration(span)
    factor = length / span if span > 0 else 1.0
    at = (record.start + record.time) * factor
    return TimeAxis(at, step * factor, f"time of the record [{unit}]", False)


def thinned(values: FloatArray, most: int) -> Rows:
    """At most so many rows: of every stretch those with the smallest and the largest value.

    Args:
        values: float[rows]; NaN is passed over, except where a stretch has nothing else.
        most: rows to keep.

    >>> thinned(np.array([0.0, 5.0, 1.0, 2.0]), 2)
    array([0, 1])
    """
    if len(values) <= most:
        return np.arange(len(values))
    keep: set[int] = set()
    for rows in np.array_split(np.arange(len(values)), max(most // 2, 1)):
        part = values[rows]
        if np.isfinite(part).any():
            keep |= {int(rows[np.nanargmin(part)]), int(rows[np.nanargmax(part)])}
        else:
            keep.add(int(rows[0]))
    return np.array(sorted(keep), dtype=np.intp)


def spaced(count: int, most: int) -> Rows:
    """At most so many rows at even distances: what is drawn as dots keeps its distribution.

    >>> spaced(9, 3)
    array([0, 4, 8])
    """
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.intp))


def _plain(value: float, _: object) -> str:
    return f"{value:.6g}".replace("-", MINUS)
