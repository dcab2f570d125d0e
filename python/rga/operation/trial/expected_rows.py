"""What rows will be like: how many days tell what is usual, how they scatter, what a year takes."""

import shutil
from collections.abc import Iterator, Sequence
from math import ceil
from pathlib import Path

import numpy as np

from rga.checking.finding import Finding, named
from rga.model import Model
from rga.operation.configuration import TwinSettings
from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.cells import cells_of
from rga.operation.sources.clock import DAY, in_words
from rga.operation.trial.what_came import WhatCame

#: rows that tell how much they scatter
ENOUGH = 20
#: part of the noise of a model below which rows are quieter than it says
QUIETER = 0.5
#: median of the absolute value of the difference of two rows, in standard deviations of one
_MEDIAN = 0.6745 * 2**0.5
YEAR = 365.25 * DAY
#: of a calibration that has seen what days differ by [s]
LEAST_CALIBRATED = 3 * DAY
#: bytes of a reading, what is simulated for it and its gap; and of a step beside its rows
READING, STEP = 24, 4_000


def calibration_findings(
    where: str, model: Model, twin: TwinSettings, calibrated: int
) -> Iterator[Finding]:
    """Whether the calibration is over before it has seen the contexts of a few days.

    Args:
        where: of which twin it is.
        model: of the twin.
        twin: its settings.
        calibrated: rows of its calibration.
    """
    takes = calibrated * twin.rows.every
    if model.context and takes < LEAST_CALIBRATED:
        what = f"the calibration takes {in_words(takes)}: what later days bring is new to the twin"
        what += ", and alarms come more often than was asked"
        rows = ceil(LEAST_CALIBRATED / twin.rows.every)
        remedy = f"give {rows} calibration_rows or more: {in_words(LEAST_CALIBRATED)}"
        yield Finding("warning", where, what, remedy)


def noise_findings(
    where: str, model: Model, twin: TwinSettings, came: Sequence[WhatCame]
) -> Iterator[Finding]:
    """Sensors whose rows scatter far less than the model says.

    The noise of a model is that of a row. What differs from row to row for other reasons only
    makes rows scatter more, so that more than the model says shows nothing.
    """
    samples = [one for source in came for one in source.samples]
    cells = cells_of(samples, list(model.sensors), twin.rows.grid.every)
    rows = np.array([one.mean for one in cells]).reshape(len(cells), len(model.sensors))
    quiet = []
    for (name, sensor), values in zip(model.sensors.items(), rows.T, strict=True):
        steps = np.abs(np.diff(values[~np.isnan(values)]))
        if sensor.noise is None or len(steps) < ENOUGH:
            continue
        # A sensor that stands still shows no noise.
        if 0 < np.median(steps) / _MEDIAN < QUIETER * sensor.noise:
            quiet.append(name)
    if quiet:
        what = f"rows scatter less than half as much as the model's noise at {named(quiet)}"
        remedy = "state the noise of a row (of a mean), not that of a sample"
        yield Finding("warning", where, what, remedy)


def growth_findings(
    where: str,
    model: Model,
    twin: TwinSettings,
    packet: int,
    came: Sequence[WhatCame],
    data: Path,
) -> Iterator[Finding]:
    """What a year takes of the disk.

    Args:
        where: of which twin it is.
        model: of the twin.
        twin: its settings.
        packet: rows of a step.
        came: what its sources have brought.
        data: a folder on the disk of the twins.
    """
    rows = YEAR / twin.rows.every
    stored = rows * (READING * len(model.sensors) + STEP / packet)
    kept = min(YEAR, twin.retention.raw or YEAR)
    packets = sum(map(_bytes_a_second, came)) * kept
    free = shutil.disk_usage(data).free
    told = f"a year takes about {_in_words(stored)} for rows"
    told += f" and {_in_words(packets)} for packets" if packets else ", and packets beside them"
    if stored + packets > free:
        what = f"{told}, and {_in_words(free)} are free"
        remedy = "make room, make fewer rows (rows.every), or keep packets shorter (retention.raw)"
        yield Finding("error", where, what, remedy)
    else:
        yield Finding("note", where, told, f"{_in_words(free)} are free")


def _bytes_a_second(came: WhatCame) -> float:
    """What a source sends in a second of its own time; 0: too little came to tell."""
    if came.first is None or came.last is None or came.last <= came.first:
        return 0.0
    return came.size * MICROSECONDS / (came.last - came.first)


def _in_words(size: float) -> str:
    """A number of bytes in the unit in which it is read best.

    >>> _in_words(2.5e9), _in_words(12e6)
    ('2.5 GB', '12 MB')
    """
    return f"{size / 1e9:.3g} GB" if size >= 1e9 else f"{size / 1e6:.3g} MB"
