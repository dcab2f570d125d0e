"""Channels that do not work, from the data alone and against the loads."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lstsq

from rga.diagnosis.row_covariance import BoolArray
from rga.model.parameter import FloatArray

#: share of rows that repeat the last one exactly, beyond which a channel is stuck
REPEATS = 0.5
#: spikes: further from the loads' best fit than this many robust deviations, and this share of rows
SPIKE = 12.0
SPIKES = 0.02
#: a channel that shows less than this share of the expected variation is dead
DEAD = 0.05
#: rows that a spike lasts at most
LONGEST_SPIKE = 2


@dataclass(frozen=True)
class Fault:
    """A channel that does not work.

    Attributes:
        sensor: its name.
        mode: "dead", "stuck" or "spiking".
        why: what in the data shows it.
        readings: number of readings that a working channel would show once in a thousand.
    """

    sensor: str
    mode: str
    why: str
    readings: int


def find_faults(
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    expected: FloatArray,
    basis: FloatArray | None,
) -> list[Fault]:
    """Channels that do not work.

    Args:
        sensors: names.
        readings: float[rows, sensors].
        observed: bool[rows, sensors].
        expected: float[sensors], the variation (standard deviation) that the simulation has.
        basis: float[rows, patterns], load coefficients; None where the loads are not known yet:
            then only stuck channels are found.
    """
    faults = []
    for number, sensor in enumerate(sensors):
        seen = observed[:, number]
        column = readings[seen, number]
        if len(column) < 4:
            continue
        repeats = float((np.diff(column) == 0).mean())
        if repeats > REPEATS:
            faults.append(
                Fault(
                    sensor,
                    "stuck",
                    f"{repeats:.0%} of its readings repeat the one before exactly",
                    int(repeats * len(column)),
                )
            )
            continue
        if basis is None:
            continue
        deviation = _robust_deviation(column - np.median(column))
        spread = float(column.std())
        rest = column - _fitted(column, basis[seen])
        scale = max(_robust_deviation(rest), 1e-12)
        spikes = float(_lone(np.abs(rest) > SPIKE * scale).mean())
        if spikes > SPIKES:
            faults.append(
                Fault(
                    sensor,
                    "spiking",
                    f"{spikes:.1%} of its readings jump away by over {SPIKE:.0f} deviations",
                    int(spikes * len(column)),
                )
            )
        elif expected[number] > 0 and spread < DEAD * expected[number]:
            faults.append(
                Fault(
                    sensor,
                    "dead",
                    f"it varies by {spread:.3g} where {expected[number]:.3g} is expected "
                    f"(median deviation {deviation:.3g})",
                    len(column),
                )
            )
    return faults


def lone_spikes(readings: FloatArray, observed: BoolArray, basis: FloatArray) -> BoolArray:
    """Readings of working channels that jump far away from what the loads allow."""
    spikes = np.zeros_like(observed)
    for number in range(readings.shape[1]):
        seen = observed[:, number]
        column = readings[seen, number]
        if len(column) > 3 * basis.shape[1]:
            rest = column - _fitted(column, basis[seen])
            far = np.abs(rest) > 3 * SPIKE * max(_robust_deviation(rest), 1e-12)
            spikes[seen, number] = _lone(far)
    return spikes


def _lone(far: BoolArray) -> BoolArray:
    """Those that stand alone or in short runs: what stays away has moved, and is no spike."""
    edges = np.flatnonzero(np.diff(far.astype(int), prepend=0, append=0))
    lone = far.copy()
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        lone[first:end] = end - first <= LONGEST_SPIKE
    return lone


def _fitted(column: FloatArray, basis: FloatArray) -> FloatArray:
    """Best fit of a column by the basis, readings far away left out."""
    few = np.column_stack([np.ones(len(column)), basis[:, : max(1, len(column) // 10)]])
    kept = np.ones(len(column), dtype=bool)
    fitted = np.full(len(column), np.median(column))
    for _ in range(4):
        weights = lstsq(few[kept], column[kept])[0]
        fitted = few @ weights
        rest = column - fitted
        kept = np.abs(rest) <= 4 * max(_robust_deviation(rest[kept]), 1e-12)
        if kept.sum() <= few.shape[1] + 3:
            return np.full(len(column), np.median(column))
    return np.asarray(fitted)


def _robust_deviation(values: FloatArray) -> float:
    return float(1.4826 * np.median(np.abs(values - np.median(values)))) if len(values) else 0.0
