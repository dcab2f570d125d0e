"""Every channel as it was measured and simulated: a small figure, and its rows to take away."""

import base64
from dataclasses import dataclass

import numpy as np
import polars as pl
import polars.selectors as cs
from markupsafe import Markup, escape

from rga.arrays import FloatArray, IntArray
from rga.findings import Findings

#: width and height of a figure, room for the axis on its left, and its foot [pixels]
WIDTH, HEIGHT, LEFT, FOOT = 760, 190, 64, 20
#: points of a line, beyond which a stretch of rows is drawn as its lowest and highest value
POINTS = 200
#: numbers in the tables of all channels together: a third of a megabyte of text
MOST_NUMBERS = 20_000
#: colours and widths: measured, as given, with the causes
LOOKS = (("#8c959f", 2.2), ("#c8641e", 1.0), ("#0072b2", 1.0))


@dataclass(frozen=True)
class Channel:
    """One channel.

    Attributes:
        name, unit: of its sensor.
        figure: what was measured and simulated over the rows.
        table: address of a CSV file that the page holds itself: time, measured, as given, with
            causes.
    """

    name: str
    unit: str
    figure: Markup
    table: str


@dataclass(frozen=True)
class Channels:
    """All channels.

    Attributes:
        each: channel by channel, in the order of the record.
        every: of the rows, every so many stand in the tables.
    """

    each: list[Channel]
    every: int


def all_channels(findings: Findings) -> Channels:
    """What was measured, simulated by the model as given and with the causes, by channel."""
    account = findings.account
    record = account.record
    numbers = 4 * len(record) * max(len(record.sensors), 1)
    every = -(-numbers // MOST_NUMBERS) if numbers else 1
    labels = [str(record.time_label(float(moment))) for moment in record.time]
    found = []
    for column, name in enumerate(record.sensors):
        unit = account.model.sensors[name].unit
        lines = [values[:, column] for values in (record.readings, account.before, account.after)]
        found.append(
            Channel(name, unit, _figure(name, unit, lines, labels), _table(labels, lines, every))
        )
    return Channels(found, every)


def _figure(name: str, unit: str, lines: list[FloatArray], labels: list[str]) -> Markup:
    finite = np.concatenate([values[np.isfinite(values)] for values in lines])
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    room = (high - low or max(abs(high), 1e-12)) * 0.05
    low, high = low - room, high + room
    paths = [
        f'<path d="{_path(values, low, high)}" fill="none" stroke="{colour}" '
        f'stroke-width="{width}"/>'
        for values, (colour, width) in zip(lines, LOOKS, strict=True)
    ]
    bottom = HEIGHT - FOOT
    text = 'font-size="11" fill="#57606a"'
    marks = [
        f'<text x="{LEFT - 6}" y="{y}" text-anchor="end" {text}>{value:.4g}</text>'
        for value, y in ((high, 12), ((low + high) / 2, bottom / 2 + 4), (low, bottom))
    ]
    ends = [
        f'<text x="{x}" y="{HEIGHT - 5}" text-anchor="{anchor}" {text}>{escape(label)}</text>'
        for x, anchor, label in (
            (LEFT, "start", labels[0] if labels else ""),
            (WIDTH, "end", labels[-1] if labels else ""),
        )
    ]
    said = escape(f"{name} [{unit}] over the rows: measured, as given, with causes")
    frame = f'<path d="M{LEFT} 0V{bottom}H{WIDTH}" fill="none" stroke="#d0d7de"/>'
    return Markup(
        f'<svg role="img" aria-label="{said}" viewBox="0 0 {WIDTH} {HEIGHT}">'
        f"{frame}{''.join(paths)}{''.join(marks)}{''.join(ends)}</svg>"
    )


def _path(values: FloatArray, low: float, high: float) -> str:
    """Values as the path of a line, broken where they are missing."""
    rows: IntArray = np.arange(len(values), dtype=np.int64)
    if len(values) > POINTS:
        # A stretch of rows shows its lowest and its highest value: nothing that sticks out is lost.
        stretches = np.array_split(rows, POINTS // 2)
        rows = np.concatenate([_extremes(values, stretch) for stretch in stretches])
    x = LEFT + (WIDTH - LEFT) * rows / max(len(values) - 1, 1)
    y = (HEIGHT - FOOT) * (high - values[rows]) / (high - low)
    parts, drawing = [], False
    for across, down in zip(x, y, strict=True):
        known = bool(np.isfinite(down))
        if known:
            parts.append(f"{'L' if drawing else 'M'}{across:.0f} {down:.1f}")
        drawing = known
    return "".join(parts)


def _extremes(values: FloatArray, rows: IntArray) -> IntArray:
    """The rows of a stretch that are lowest and highest, in their order."""
    known = rows[np.isfinite(values[rows])]
    if not len(known):
        return rows[:1]
    return np.unique([known[np.argmin(values[known])], known[np.argmax(values[known])]])


def _table(labels: list[str], lines: list[FloatArray], every: int) -> str:
    columns = zip(("measured", "as given", "with causes"), lines, strict=True)
    frame = pl.DataFrame({"time": labels} | dict(columns))
    numbers = cs.float().fill_nan(None).round_sig_figs(9)
    text = frame.with_columns(numbers).gather_every(every).write_csv()
    return "data:text/csv;base64," + base64.b64encode(text.encode()).decode()
