"""What rows will be like: how many days tell what is usual, how they scatter, what a year takes."""

from collections.abc import Iterator, Sequence
from math import ceil

import numpy as np

from rga.checking.finding import Finding, named
from rga.model import Model
from rga.numerics.robust_spread import robust_spread
from rga.operation.configuration import TwinSettings
from rga.operation.disk.forecast import MAKE_ROOM, YearlyGrowth, yearly_growth
from rga.operation.disk.room import DiskRoom
from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.cells import cells_of
from rga.operation.short_calibration import LEAST_CALIBRATED, is_short
from rga.operation.sources.clock import in_words
from rga.operation.trial.twin_files import TwinFiles
from rga.operation.trial.what_came import WhatCame
from rga.quantities import bytes_in_words

#: rows that tell how much they scatter
ENOUGH = 20
#: part of the noise of a model below which rows are quieter than it says
QUIETER = 0.5


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
    if is_short(model, calibrated, twin.rows.every):
        takes = in_words(calibrated * twin.rows.every)
        what = f"the calibration takes {takes}: what later days bring is new to the twin"
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
        steps = np.diff(values[~np.isnan(values)])
        if sensor.noise is None or len(steps) < ENOUGH:
            continue
        # A sensor that stands still shows no noise.
        if 0 < robust_spread(steps) / 2**0.5 < QUIETER * sensor.noise:
            quiet.append(name)
    if quiet:
        what = f"rows scatter less than half as much as the model's noise at {named(quiet)}"
        remedy = "state the noise of a row (of a mean), not that of a sample"
        yield Finding("warning", where, what, remedy)


def growth_of(files: TwinFiles, came: Sequence[WhatCame]) -> YearlyGrowth:
    """What a twin takes of the disk in a year.

    Args:
        files: of the twin.
        came: what its sources have brought.
    """
    values = len(files.model.sensors) + len(files.model.context)
    packet = files.run.pace(None).packet
    return yearly_growth(files.settings, values, packet, sum(map(_bytes_a_second, came)))


def growth_note(where: str, growth: YearlyGrowth, free: int) -> Finding:
    """What a twin takes of the disk in a year, in words."""
    told = f"a year takes about {bytes_in_words(growth.rows)} for rows"
    if growth.packets:
        told += f" and {bytes_in_words(growth.packets)} for packets"
    else:
        told += ", and packets beside them"
    return Finding("note", where, told, f"{bytes_in_words(free)} are free")


def room_findings(growths: Sequence[YearlyGrowth], room: DiskRoom) -> Iterator[Finding]:
    """Whether there is room for a year of all twins."""
    total, free = sum(one.total for one in growths), room.free
    if total > free:
        what = f"a year of all twins takes about {bytes_in_words(total)}"
        what += f", and {bytes_in_words(free)} are free"
        yield Finding("error", f"[service] data = {str(room.data)!r}", what, MAKE_ROOM)


def _bytes_a_second(came: WhatCame) -> float:
    """What a source sends in a second of its own time; 0: too little came to tell."""
    if came.first is None or came.last is None or came.last <= came.first:
        return 0.0
    return came.size * MICROSECONDS / (came.last - came.first)
