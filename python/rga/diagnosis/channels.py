"""Channels that do not work, from the data alone and against the loads."""

from dataclasses import dataclass
from typing import Literal

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
#: rows that a channel repeats itself to the last before it is silent, times what chance allows, and
#: the share of its variation that the simulation must have meanwhile
SILENT, UNLIKELY, MOVES = 10, 4.0, 0.2
#: other channels that leave their fit in the same row, from which on it is no spike of a gauge
TOGETHER = 2
#: rows that a spike lasts at most
LONGEST_SPIKE = 2


@dataclass(frozen=True)
class Fault:
    """A channel that does not work.

    Attributes:
        sensor: its name.
        mode: "dead", "stuck" or "spiking".
        why: what in the data shows it.
        row: from which on it does not work; None: from the first.
        readings: number of readings that a working channel would show once in a thousand.
    """

    sensor: str
    mode: Literal["dead", "stuck", "spiking"]
    why: str
    readings: int
    row: int | None = None


def find_faults(
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    simulated: FloatArray | None = None,
    basis: FloatArray | None = None,
) -> list[Fault]:
    """Channels that do not work.

    Args:
        sensors: names.
        readings: float[rows, sensors].
        observed: bool[rows, sensors].
        simulated: float[rows, sensors]; None where the loads are not known yet: then only channels
            are found that are stuck over most of the record.
        basis: float[rows, patterns], load coefficients; None as well then.
    """
    faults = []
    jumps = np.zeros_like(observed) if basis is None else _jumps(readings, observed, basis)
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
        if basis is None or simulated is None:
            continue
        expected = float(simulated[:, number].std())
        silent = _falls_silent(column, simulated[seen, number])
        if silent is not None:
            row = int(np.flatnonzero(seen)[silent])
            value = column[silent]
            mode: Literal["dead", "stuck"] = "dead" if value == 0 else "stuck"
            why = f"it reads {value:.6g} exactly from row {row + 1} to the last"
            faults.append(Fault(sensor, mode, why, len(column) - silent, row))
            continue
        deviation = _robust_deviation(column - np.median(column))
        spread = float(column.std())
        spikes = float(jumps[seen, number].mean())
        if spikes > SPIKES:
            faults.append(
                Fault(
                    sensor,
                    "spiking",
                    f"{spikes:.1%} of its readings jump away by over {SPIKE:.0f} deviations",
                    int(spikes * len(column)),
                )
            )
        elif spread < DEAD * expected:
            faults.append(
                Fault(
                    sensor,
                    "dead",
                    f"it varies by {spread:.3g} where {expected:.3g} is expected "
                    f"(median deviation {deviation:.3g})",
                    len(column),
                )
            )
    return faults


def _falls_silent(column: FloatArray, simulated: FloatArray) -> int | None:
    """The reading from which on a channel repeats itself to the last, if it does for long.

    Args:
        column: readings, float[readings].
        simulated: what they should be, float[readings]: it must vary meanwhile.
    """
    changes = np.flatnonzero(np.diff(column) != 0)
    first = int(changes[-1]) + 1 if len(changes) else 0
    # Readings of coarse steps repeat themselves by chance, the more the coarser.
    repeats = float((np.diff(column[: first + 1]) == 0).mean()) if first else 1.0
    by_chance = 1 + np.log(len(column)) / np.log(1 / max(repeats, 1e-3)) if repeats < 1 else np.inf
    silent = len(column) - first
    if silent < max(SILENT, UNLIKELY * by_chance):
        return None
    moves = simulated[first:].std() > MOVES * simulated.std()
    return first if moves else None


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


def _jumps(readings: FloatArray, observed: BoolArray, basis: FloatArray) -> BoolArray:
    """Readings that jump away by themselves: where other channels leave too, it is no gauge."""
    away = np.zeros_like(readings)
    for number in range(readings.shape[1]):
        seen = observed[:, number]
        if seen.any():
            rest = readings[seen, number] - _fitted(readings[seen, number], basis[seen])
            away[seen, number] = np.abs(rest) / max(_robust_deviation(rest), 1e-12)
    jumps = np.zeros_like(observed)
    for number, far in enumerate((away > SPIKE).T):
        seen = observed[:, number]
        jumps[seen, number] = _lone(far[seen])
    others = (away > SPIKE / 2).sum(1)[:, None] - (away > SPIKE / 2)
    return np.asarray(jumps & (others < TOGETHER))


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
