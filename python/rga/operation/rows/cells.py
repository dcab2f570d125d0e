"""A cell of the grid in time, and what the samples within it come to."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from rga.arrays import FloatArray
from rga.operation.packets.packet import Moments

Counts = npt.NDArray[np.int64]


@dataclass(frozen=True)
class SensorSamples:
    """Readings in the units of a model.

    Attributes:
        names: sensors and context variables.
        times: int64[n], microseconds since 1970 (UTC), in any order.
        values: float64[n, names], NaN where one is missing.
        refused: columns that came beside them and are not used though nobody leaves them out,
            with the reason.
    """

    names: tuple[str, ...]
    times: Moments
    values: FloatArray
    refused: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Cell:
    """What the samples within one cell come to.

    Attributes:
        begin: of the cell, microseconds since 1970 (UTC).
        count: of samples, int64[names].
        mean: float64[names], NaN where there is no sample.
        deviation: standard deviation of the samples, float64[names], NaN below two samples.
        least, most: float64[names], NaN where there is no sample.
        conflicts: samples that were left out, as another value of the same moment came before,
            int64[names].
    """

    begin: int
    count: Counts
    mean: FloatArray
    deviation: FloatArray
    least: FloatArray
    most: FloatArray
    conflicts: Counts


def cell_of(moment: int, every: int) -> int:
    """Begin of the cell [k * every, (k + 1) * every) that holds a moment [µs].

    >>> cell_of(119, 60), cell_of(120, 60), cell_of(-1, 60)
    (60, 120, -60)
    """
    return moment - moment % every


def cells_of(parts: Sequence[SensorSamples], names: Sequence[str], every: int) -> list[Cell]:
    """The cells that hold samples, in time.

    What comes of the same samples does not hang on the order in which they arrived, but for
    values of one channel at one moment: the first of them counts.

    Args:
        parts: in the order in which they arrived.
        names: sensors and context variables that the cells are of; others are left out.
        every: length of a cell [µs].
    """
    if not any(len(part.times) for part in parts):
        return []
    times = np.concatenate([part.times for part in parts])
    values = np.full((len(times), len(names)), np.nan)
    row = 0
    for part in parts:
        rows = slice(row, row := row + len(part.times))
        for k, name in enumerate(names):
            if name in part.names:
                values[rows, k] = part.values[:, part.names.index(name)]
    order = np.argsort(times, kind="stable")
    times, values, conflicts = _one_a_moment(times[order], values[order])
    begins = times - times % every
    edges = np.flatnonzero(np.diff(begins, prepend=begins[0] - 1))
    return [
        _cell(int(begins[first]), values[first:last], conflicts[first:last].sum(axis=0))
        for first, last in zip(edges, [*edges[1:], len(times)], strict=True)
    ]


def _one_a_moment(times: Moments, values: FloatArray) -> tuple[Moments, FloatArray, Counts]:
    """Of samples in time, one for every moment: the first value of each channel.

    Returns:
        Times, values, and how many other values of each channel are left out at each moment.
    """
    first = np.flatnonzero(np.diff(times, prepend=times[0] - 1))
    held, conflicts = values[first], np.zeros((len(first), values.shape[1]), np.int64)
    repeats = np.diff(first, append=len(times))
    for k in range(1, int(repeats.max())):
        again = np.flatnonzero(repeats > k)
        before, now = held[again], values[first[again] + k]
        conflicts[again] += ~np.isnan(now) & ~np.isnan(before) & (now != before)
        held[again] = np.where(np.isnan(before), now, before)
    return times[first], held, conflicts


def _cell(begin: int, values: FloatArray, conflicts: Counts) -> Cell:
    there = ~np.isnan(values)
    count = there.sum(axis=0)
    held = np.where(there, values, 0.0)
    # The mean of one sample, or of equal ones, is that sample to the last bit.
    reference = held[np.argmax(there, axis=0), np.arange(held.shape[1])]
    apart = np.where(there, held - reference, 0.0)
    some = np.maximum(count, 1)
    offset = apart.sum(axis=0) / some
    squares = np.where(there, apart - offset, 0.0) ** 2
    several = np.maximum(count - 1, 1)
    return Cell(
        begin=begin,
        count=count,
        mean=np.where(count > 0, reference + offset, np.nan),
        deviation=np.where(count > 1, np.sqrt(squares.sum(axis=0) / several), np.nan),
        least=np.where(count > 0, np.where(there, values, np.inf).min(axis=0), np.nan),
        most=np.where(count > 0, np.where(there, values, -np.inf).max(axis=0), np.nan),
        conflicts=conflicts,
    )
