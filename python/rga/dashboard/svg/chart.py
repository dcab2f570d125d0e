"""Lines over time that are drawn by the server, and keep their sharpness at any width.

The lines are stretched to the width of the page; ticks and marks are text at a share of it, so
that a phone shows them in the same size.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Literal

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.date_formats import BESIDE_DATES, DATES, ROUND_DATES
from rga.operation.reading.overview import Floats, Trace
from rga.quantities import number, short

#: size of the plane on which lines are drawn, before it is stretched
WIDE, HIGH = 1000.0, 200.0
#: share of the height that stays free above and below the lines
MARGIN = 0.06
#: gaps below this are drawn as if they were this large: they say nothing
LEAST_GAP = 0.1
#: entries of a line, more than the eye tells apart
POINTS = 500
#: ticks of an axis at least, and what may stand at one between a power of ten and the next
LEAST_TICKS = 3
FACTORS = ((1.0,), (1.0, 3.0), (1.0, 2.0, 5.0))
Look = Literal["measured", "simulated", "gap", "context", "residual"]


@dataclass(frozen=True)
class Column:
    """A line that is to be drawn.

    Attributes:
        name: of it.
        look: by which the style sheet tells it apart.
        mean, least, most: float[n].
    """

    name: str
    look: Look
    mean: Floats
    least: Floats
    most: Floats


@dataclass(frozen=True)
class ChartLine:
    """A line that is drawn.

    Attributes:
        name, look: as of its column.
        path: of the line.
        band: around the least and the most of each entry; empty where they are one.
        last: its last value, in words.
    """

    name: str
    look: Look
    path: str
    band: str
    last: str


@dataclass(frozen=True)
class Tick:
    """A number beside an axis: the share of its length [%], and what stands there."""

    at: float
    words: str


@dataclass(frozen=True)
class ChartMark:
    """Something that happened.

    Attributes:
        at: share of the width [%].
        kind: by which the style sheet gives it a shape.
        words: what happened.
        href: what is shown of it.
    """

    at: float
    kind: str
    words: str
    href: str


@dataclass(frozen=True)
class TimeChart:
    """Lines over time.

    Attributes:
        title, unit: of the values.
        lines: in the order in which they are drawn.
        across, up: ticks of time and of values.
        date: what the ticks of time leave out.
        marks: what happened meanwhile.
        words: what the chart shows, for readers who do not see it.
        logarithmic: a step upwards is a factor.
    """

    title: str
    unit: str
    lines: tuple[ChartLine, ...]
    across: tuple[Tick, ...]
    date: str
    up: tuple[Tick, ...]
    marks: tuple[ChartMark, ...]
    words: str
    logarithmic: bool


@dataclass(frozen=True)
class Window:
    """A stretch of time.

    Attributes:
        start: time of the first row of all.
        begin, end: [s since then].
    """

    start: datetime
    begin: float
    end: float

    def share(self, elapsed: float) -> float:
        """Where a time [s since the first row] stands [% of the width]."""
        return 100.0 * (elapsed - self.begin) / max(self.end - self.begin, 1e-9)

    def moment(self, elapsed: float) -> datetime:
        """The time at so many seconds since the first row."""
        return self.start + timedelta(seconds=elapsed)


def column(name: str, look: Look, trace: Trace, number: int) -> Column:
    """A column of a trace, to be drawn."""
    parts = (trace.mean, trace.least, trace.most)
    return Column(name, look, *(one[:, number] for one in parts))


def chart(
    title: str,
    unit: str,
    time: FloatArray,
    columns: Sequence[Column],
    window: Window,
    *,
    marks: Sequence[ChartMark] = (),
    logarithmic: bool = False,
) -> TimeChart:
    """Draw columns over time.

    Args:
        title, unit: of the values.
        time: of the entries [s since the first row], float[n].
        columns: to be drawn; NaN leaves a hole.
        window: of time.
        marks: what happened meanwhile.
        logarithmic: a step upwards is a factor, as for gaps.
    """
    low, high = _range(columns, logarithmic)

    def height(values: Floats) -> FloatArray:
        shown = _logarithm(values) if logarithmic else np.asarray(values, dtype=float)
        share = MARGIN + (1 - 2 * MARGIN) * (shown - low) / (high - low)
        return np.asarray(HIGH * (1 - share))

    x = WIDE * np.array([window.share(one) for one in time]) / 100.0
    lines = tuple(
        ChartLine(
            one.name,
            one.look,
            _path(x, height(one.mean)),
            "" if one.least is one.most else _band(x, height(one.least), height(one.most)),
            _last(one.mean),
        )
        for one in columns
    )
    said = ", ".join(f"{one.name} {one.last} {unit}".strip() for one in lines)
    return TimeChart(
        title,
        unit,
        lines,
        *time_ticks(window),
        tuple(
            Tick(round(100 * float(height(np.array([value]))[0]) / HIGH, 2), short(value))
            for value in _steps(low, high, logarithmic)
        ),
        tuple(one for one in marks if 0 <= one.at <= 100),
        f"{title}, at the end: {said}",
        logarithmic,
    )


def sparkline(time: FloatArray, gap: Floats, window: Window) -> str:
    """The path of a small line of gaps, on the plane of `WIDE` and `HIGH`."""
    one = Column("gap", "gap", gap, gap, gap)
    return chart("gap", "", time, [one], window, logarithmic=True).lines[0].path


def time_ticks(window: Window) -> tuple[tuple[Tick, ...], str]:
    """Round times in UTC, and what they leave out.

    >>> one = Window(datetime(2026, 11, 23, tzinfo=UTC), 0.0, 86_400.0)
    >>> ticks, date = time_ticks(one)
    >>> [tick.words for tick in ticks], date
    (['11-23', '06:00', '12:00', '18:00', '11-24'], '2026-11-24')
    """
    # With the first chart, not with the service, which answers sooner so.
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter, date2num, num2date

    ends = [window.moment(one) for one in (window.begin, max(window.end, window.begin + 1.0))]
    locator = AutoDateLocator(tz=UTC, minticks=3, maxticks=6)  # type: ignore[no-untyped-call]
    formatter = ConciseDateFormatter(  # type: ignore[no-untyped-call]
        locator,
        tz=UTC,
        formats=DATES,
        zero_formats=ROUND_DATES,
        offset_formats=BESIDE_DATES,
    )
    low, high = (float(date2num(one)) for one in ends)  # type: ignore[no-untyped-call]
    places = [one for one in locator.tick_values(*ends) if low <= one <= high]  # type: ignore[no-untyped-call]
    words = formatter.format_ticks(places)  # type: ignore[no-untyped-call]
    found = []
    for place, text in zip(places, words, strict=True):
        elapsed = (num2date(place, tz=UTC) - window.start).total_seconds()  # type: ignore[no-untyped-call]
        found.append(Tick(round(window.share(elapsed), 2), text))
    return tuple(found), str(formatter.get_offset())  # type: ignore[no-untyped-call]


def _range(columns: Sequence[Column], logarithmic: bool) -> tuple[float, float]:
    """Least and largest of all that is drawn; on a scale of factors, their logarithms."""
    values = [part for one in columns for part in (one.mean, one.least, one.most)]
    found = np.concatenate([np.ravel(one) for one in values]) if values else np.zeros(0)
    found = np.asarray(_logarithm(found) if logarithmic else found, dtype=float)
    found = found[np.isfinite(found)]
    if not len(found):
        return 0.0, 1.0
    low, high = float(found.min()), float(found.max())
    if logarithmic:
        # A gap is seen beside that of noise alone.
        low, high = min(low, np.log10(0.5)), max(high, 1.0)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _logarithm(values: Floats) -> FloatArray:
    shown = np.asarray(values, dtype=float)
    return np.asarray(np.log10(np.maximum(shown, LEAST_GAP)))


def _steps(low: float, high: float, logarithmic: bool) -> list[float]:
    from matplotlib.ticker import MaxNLocator

    if logarithmic:
        return _factors(low, high)
    return [float(one) for one in MaxNLocator(4).tick_values(low, high) if low <= one <= high]


def _factors(low: float, high: float) -> list[float]:
    """Round numbers on a scale of factors: those of ten, and others where these are few."""
    from matplotlib.ticker import LogLocator

    found: list[float] = []
    for within_ten in FACTORS:
        steps = LogLocator(subs=within_ten, numticks=5).tick_values(10.0**low, 10.0**high)
        found = [float(one) for one in steps if low <= np.log10(one) <= high]
        if len(found) >= LEAST_TICKS:
            break
    return found


def _path(x: FloatArray, y: FloatArray) -> str:
    """A line with holes; what stands alone is a dot."""
    return "".join(
        f"M{_points(x[run], y[run])}{'h.1' if len(run) == 1 else ''}" for run in _runs(y)
    )


def _band(x: FloatArray, low: FloatArray, high: FloatArray) -> str:
    found = []
    for run in _runs(low + high):
        there, back = _points(x[run], low[run]), _points(x[run][::-1], high[run][::-1])
        found.append(f"M{there}L{back}Z")
    return "".join(found)


def _points(x: FloatArray, y: FloatArray) -> str:
    return "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(x.tolist(), y.tolist(), strict=True))


def _runs(values: FloatArray) -> list["np.ndarray[tuple[int], np.dtype[np.intp]]"]:
    """Places of what is finite, cut where something is not."""
    there = np.flatnonzero(np.isfinite(values))
    return [run for run in np.split(there, np.flatnonzero(np.diff(there) > 1) + 1) if len(run)]


def _last(values: Floats) -> str:
    known = values[np.isfinite(values)]
    return number(float(known[-1])) if len(known) else "–"
