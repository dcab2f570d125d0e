"""Faults of a channel that its readings show by themselves, or beside the simulation."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.findings.criteria.channels import ChannelCriteria
from rga.model.schema import Model

#: relative rounding of readings that are the same
ROUNDING = 1e-9
#: readings that are enough to judge a channel by the share that repeats; of fewer, coarse ones
#: repeat by chance: so many standard deviations of a share of one half are allowed them
ENOUGH, BY_CHANCE = 60, 3.0
#: steps between its levels by which a channel shows that its logger is coarse
FEWEST_STEPS = 5

Mode = Literal["dead", "stuck", "spiking", "erratic", "copy", "scale"]


@dataclass(frozen=True)
class BrokenChannel:
    """A channel that does not work.

    Attributes:
        sensor: its name.
        mode: how: see `SensorFault`.
        why: what in the data shows it.
        row: from which on it does not work; None: from the first.
        readings: number of readings that a working channel would show once in a thousand.
    """

    sensor: str
    mode: Mode
    why: str
    readings: int
    row: int | None = None


def stuck_channels(
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    criteria: ChannelCriteria,
) -> list[BrokenChannel]:
    """Channels that stand still over most of the record, whatever the loads are.

    Args:
        sensors: names.
        readings: float[rows, sensors].
        observed: bool[rows, sensors].
        criteria: when a channel is stuck.
    """
    faults = []
    for number, sensor in enumerate(sensors):
        column = readings[observed[:, number], number]
        if len(column) <= 3:
            continue
        repeats = float((np.diff(column) == 0).mean())
        if repeats > criteria.repeats + _by_chance(len(column)) and not _coarse(column, criteria):
            why = f"{repeats:.0%} of its readings repeat the one before exactly"
            faults.append(BrokenChannel(sensor, "stuck", why, int(repeats * len(column))))
    return faults


def _by_chance(readings: int) -> float:
    """Share of repeats that so many coarse readings may have by chance beyond what is usual.

    >>> _by_chance(12) > 0.4, _by_chance(60)
    (True, 0.0)
    """
    return BY_CHANCE * 0.5 / float(np.sqrt(readings)) if readings < ENOUGH else 0.0


def _coarse(column: FloatArray, criteria: ChannelCriteria) -> bool:
    """Whether a channel moves step by step, so that it repeats itself where it moves slowly.

    What is stuck, and comes loose now and then, moves by many steps of its logger at once, or
    stands still for much longer than it does elsewhere.

    >>> fine = np.cumsum(np.random.default_rng(1).normal(0.0, 0.05, 300))
    >>> walk = np.round(fine, 1)
    >>> frozen = np.where(np.arange(300) < 200, walk[0], walk)
    >>> [_coarse(one, ChannelCriteria()) for one in (walk, frozen, np.repeat(fine[::2], 2))]
    [True, False, False]
    """
    levels = np.unique(column)
    apart = np.diff(levels)
    rounding = ROUNDING * float(np.abs(levels).max(initial=0.0))
    steps = apart[apart > rounding]
    if len(steps) < FEWEST_STEPS:
        return False
    moves = np.abs(np.diff(column))
    still = moves <= rounding
    first, end = _longest(still)
    elsewhere = (
        float(np.delete(still, slice(first, end)).mean()) if end - first < len(still) else 1.0
    )
    if end - first > criteria.still_chance * _run_by_chance(elsewhere, len(column)):
        return False
    return bool((moves[~still] < 1.5 * steps.min()).mean() >= 0.5)


def _run_by_chance(repeats: float, readings: int) -> float:
    """Readings that repeat in a row by chance, where a share of all does."""
    if repeats >= 1:
        return float("inf")
    return 1 + float(np.log(readings) / np.log(1 / max(repeats, 1e-3)))


def lost_zeros(
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    loaded: BoolArray,
    criteria: ChannelCriteria,
) -> list[BrokenChannel]:
    """Channels that do not read the same behind a crossing as before it.

    Args:
        sensors: names.
        readings: float[rows, sensors].
        observed: bool[rows, sensors].
        loaded: rows under load, bool[rows].
        criteria: how far off a channel may stay.
    """
    rows = np.flatnonzero(loaded)
    if not len(rows):
        return []
    faults = []
    for number, sensor in enumerate(sensors):
        seen = observed[:, number]
        before, behind = seen.copy(), seen.copy()
        before[rows[0] :] = False
        behind[: rows[-1] + 1] = False
        during = seen & ~before & ~behind
        if min(before.sum(), behind.sum()) < criteria.still_rows or not during.any():
            continue
        level = float(np.median(readings[before, number]))
        off = float(np.median(readings[behind, number])) - level
        peak = float(np.abs(readings[during, number] - level).max())
        if abs(off) > criteria.returns * peak:
            why = (
                f"behind the crossing it stays off by {off:.3g}, {abs(off) / peak:.0%} of its peak"
            )
            faults.append(BrokenChannel(sensor, "erratic", why, int(behind.sum())))
    return faults


def silent(
    sensor: str,
    column: FloatArray,
    seen: BoolArray,
    simulated: FloatArray,
    criteria: ChannelCriteria,
) -> BrokenChannel | None:
    """A channel that repeats itself to the last reading, where it should move."""
    measured, expected = column[seen], simulated[seen]
    changes = np.flatnonzero(np.diff(measured) != 0)
    first = int(changes[-1]) + 1 if len(changes) else 0
    # Readings of coarse steps repeat themselves by chance, the more the coarser.
    repeats = float((np.diff(measured[: first + 1]) == 0).mean()) if first else 1.0
    by_chance = _run_by_chance(repeats, len(measured))
    silent = len(measured) - first
    if silent < max(criteria.still_rows, criteria.still_chance * by_chance):
        return None
    if expected[first:].std() <= criteria.still_moves * expected.std():
        return None
    row, value = int(np.flatnonzero(seen)[first]), measured[first]
    why = f"it reads {value:.6g} exactly from row {row + 1} to the last"
    return BrokenChannel(sensor, "dead" if value == 0 else "stuck", why, silent, row)


def copied(
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    simulated: FloatArray,
    number: int,
    criteria: ChannelCriteria,
) -> BrokenChannel | None:
    """A channel that holds the readings of another, and not its own."""
    both = observed[:, [number]] & observed
    # A zero that was taken off each by itself leaves them a constant apart.
    apart = np.where(both, readings[:, [number]] - readings, np.nan)
    rounding = ROUNDING * np.where(both, np.abs(readings), 0.0).max(0)
    enough = both.sum(0) > 3
    enough[number] = False
    apart[:, ~enough] = 0.0
    same = np.abs(apart - np.nanmedian(apart, axis=0)) <= rounding
    for other in np.flatnonzero(enough & (same.sum(0) >= criteria.still_rows)):
        rows = np.flatnonzero(both[:, other])
        first, end = _longest(same[rows, other])
        copied = rows[first:end]
        if end - first < criteria.still_rows or np.ptp(readings[copied, other]) == 0:
            continue
        own, theirs = (_misfit(readings[copied, k], simulated[copied, k]) for k in (number, other))
        if own > theirs:
            row = int(rows[first]) if end == len(rows) and first > 0 else None
            why = f"{end - first} readings in a row are exactly those of {sensors[other]}"
            return BrokenChannel(sensors[number], "copy", why, end - first, row)
    return None


def _longest(marked: BoolArray) -> tuple[int, int]:
    """First row and end of the longest run of marked rows."""
    edges = np.flatnonzero(np.diff(marked.astype(int), prepend=0, append=0)).reshape(-1, 2)
    if not len(edges):
        return 0, 0
    first, end = edges[int(np.argmax(edges[:, 1] - edges[:, 0]))]
    return int(first), int(end)


def _misfit(column: FloatArray, simulated: FloatArray) -> float:
    """How little a channel goes with its simulation: share of the simulation that it misses."""
    power = float(((simulated - simulated.mean()) ** 2).sum())
    off = column - column.mean() - (simulated - simulated.mean())
    return float((off**2).sum()) / max(power, 1e-300)


@dataclass(frozen=True)
class Answer:
    """How a channel goes with its simulation.

    Attributes:
        size: standard deviation of the simulation [its unit].
        slope: of the readings against it [-]; None where they do not go with it.
        readings: how many there are.
    """

    size: float
    slope: float | None
    readings: int


def answers(
    readings: FloatArray, observed: BoolArray, simulated: FloatArray, criteria: ChannelCriteria
) -> list[Answer | None]:
    """That of every channel; None where the readings are few, or nothing moves."""
    found: list[Answer | None] = []
    for seen, column, expected in zip(observed.T, readings.T, simulated.T, strict=True):
        own, should = column[seen], expected[seen]
        if len(own) <= 3 or should.std() == 0 or own.std() == 0:
            found.append(None)
            continue
        (_, between), (_, variance) = np.cov(own, should)
        goes = abs(float(np.corrcoef(own, should)[0, 1])) > criteria.scale_correlation
        slope = float(between / variance) if goes else None
        found.append(Answer(float(should.std()), slope, len(own)))
    return found


def scaled(
    model: Model,
    sensors: tuple[str, ...],
    of_channels: list[Answer | None],
    number: int,
    criteria: ChannelCriteria,
) -> BrokenChannel | None:
    """A channel that answers as it should, many times too much or too little.

    Args:
        model: tells which sensors are of a kind.
        sensors: names.
        of_channels: how each answers.
        number: of the channel.
        criteria: when it is broken.
    """
    own, kind = of_channels[number], model.sensors[sensors[number]].kind
    if own is None or own.slope is None:
        return None
    like = [
        one
        for one, name in zip(of_channels, sensors, strict=True)
        if one is not None and model.sensors[name].kind == kind
    ]
    others = [
        (abs(one.slope), one.size) for one in like if one is not own and one.slope is not None
    ]
    if len(others) < 2:
        return None
    usual = float(np.median([slope for slope, _ in others]))
    least = criteria.scale_variation * float(np.median([one.size for one in like]))
    if own.size < least or usual == 0:
        return None
    factor = own.slope / usual
    largest = max(slope * size for slope, size in others)
    beyond = abs(own.slope) * own.size > criteria.scale * largest
    if (abs(factor) > criteria.scale and beyond) or abs(factor) < 1 / criteria.scale**2:
        why = f"it answers {factor:.3g} times as much as its like: check its unit and its range"
        return BrokenChannel(sensors[number], "scale", why, own.readings)
    return None


def dead(
    sensor: str, column: FloatArray, simulated: FloatArray, criteria: ChannelCriteria
) -> BrokenChannel | None:
    """A channel that hardly varies where it should."""
    spread, expected = float(column.std()), float(simulated.std())
    if spread >= criteria.dead * expected:
        return None
    why = f"it varies by {spread:.3g} where {expected:.3g} is expected"
    return BrokenChannel(sensor, "dead", why, len(column))
