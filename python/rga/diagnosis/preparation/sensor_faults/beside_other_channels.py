"""Channels that do not work, found by what the loads and the other channels predict of them.

A channel is rejected where it says what no structure under these loads says, alone among the
channels, and far beyond its noise: whatever broke it. What an effect of the vocabulary could do to
a channel is left to the search for causes: a jump, a slope, another response from some row on, or
the time history of a bearing that sticks. What goes with the square of its own reading, or lags
behind it, is left to the curves among the residuals.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.preparation.sensor_faults.channel_prediction import (
    ROWS_PER_COURSE,
    OwnParts,
    beyond_others,
    own_parts,
    robust_deviation,
    robust_fit,
    root_mean_square,
)
from rga.diagnosis.preparation.sensor_faults.own_readings import (
    ENOUGH,
    BrokenChannel,
    answers,
    copied,
    dead,
    scaled,
    silent,
)
from rga.findings.criteria.channels import ChannelCriteria
from rga.model.effects.sensors.zero_offset import offset_scale
from rga.model.schema import Model
from rga.numerics.hysteresis import PLAY, play

#: rows for each time history of the loads to which the response may change from a moment on
ROWS_PER_CHANGE = 16
#: shares of the record over which a broken channel may have worked
PARTS = np.arange(0.3, 0.96, 0.05)
#: moments at which another response is tried, and the share of the rows before the first
MOMENTS, MARGIN = 40, 0.05

#: times what the steps of contexts may show, up to which they are what a channel shows
ROUNDED = 2.0
#: modes that may begin at any row
PARTIAL = ("spiking", "erratic")


def broken_channels(
    model: Model,
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    simulated: FloatArray,
    basis: FloatArray,
    effects: Callable[[], Sequence[FloatArray]],
    rounding: Callable[[], FloatArray],
    onsets: bool,
    criteria: ChannelCriteria,
) -> list[BrokenChannel]:
    """Channels that do not work, by the simulation and by what the others predict of them.

    Args:
        model: states the noise of sensors, and which are of a kind.
        sensors: names.
        readings: float[rows, sensors].
        observed: bool[rows, sensors].
        simulated: float[rows, sensors].
        basis: courses of the loads, float[rows, courses].
        effects: called where a channel is suspect: what effects of the structure change that no
            time history of the loads shows, float[rows, sensors] each.
        rounding: called there as well: what the steps in which contexts are given may show on each
            channel, as a standard deviation, float[sensors].
        onsets: whether a search for causes may say that something begins late.
        criteria: when a channel is broken.
    """
    parts = own_parts(model, sensors, readings, observed, basis, simulated)
    suspects = [
        number
        for number in range(len(sensors))
        if observed[:, number].sum() >= _fewest(basis)
        and _too_large(parts, readings, observed, number, criteria)
    ]
    possible = effects() if suspects else []
    rounded = rounding() if suspects else np.zeros(len(sensors))
    size = root_mean_square(parts.own)
    of_channels = answers(readings, observed, simulated, criteria)
    faults = []
    for number, sensor in enumerate(sensors):
        seen = observed[:, number]
        if seen.sum() <= 3:
            continue
        found = (
            silent(sensor, readings[:, number], seen, simulated[:, number], criteria)
            or copied(sensors, readings, observed, simulated, number, criteria)
            or scaled(model, sensors, of_channels, number, criteria)
            or dead(sensor, readings[seen, number], simulated[seen, number], criteria)
        )
        # A channel that alone goes with a context shows how coarsely it is given.
        if found is None and number in suspects and size[number] > ROUNDED * rounded[number]:
            others = [k for k in range(len(sensors)) if k == number or k not in suspects]
            if not _explained(parts, possible, number, others, criteria):
                found = _erratic(
                    model, sensor, parts, observed, basis, simulated, number, onsets, criteria
                )
        if found is not None:
            faults.append(found)
    if any(one.mode in PARTIAL and one.row is None for one in faults):
        until = dict(
            zip(
                sensors,
                _working_until(model, sensors, readings, observed, basis, simulated, criteria),
                strict=True,
            )
        )
        faults = [_begun(one, int(until[one.sensor])) for one in faults]
    return faults


def _fewest(basis: FloatArray) -> int:
    """Readings below which nothing is said of a channel's own ways.

    With fewer not all time histories of the loads are fitted, and what is left is theirs.
    """
    return min(ROWS_PER_COURSE * (1 + int(basis.shape[1])), ENOUGH)


def _begun(fault: BrokenChannel, row: int) -> BrokenChannel:
    """A fault from the row on up to which its channel works."""
    if fault.mode not in PARTIAL or fault.row is not None or row == 0:
        return fault
    return replace(fault, row=row, why=f"{fault.why} (it works up to row {row})")


def lone_spikes(
    readings: FloatArray, observed: BoolArray, basis: FloatArray, criteria: ChannelCriteria
) -> BoolArray:
    """Readings of working channels that jump far away from what the loads allow."""
    spikes = np.zeros_like(observed)
    for number in range(readings.shape[1]):
        seen = observed[:, number]
        column = readings[seen, number]
        if len(column) > 3 * basis.shape[1]:
            rest = column - robust_fit(column, basis[seen])
            far = np.abs(rest) > criteria.lone_spike * max(robust_deviation(rest), 1e-12)
            spikes[seen, number] = _lone(far, criteria.longest_spike)
    return spikes


def _too_large(
    parts: OwnParts,
    readings: FloatArray,
    observed: BoolArray,
    number: int,
    criteria: ChannelCriteria,
) -> bool:
    if np.isfinite(parts.usual[number]):
        return bool(parts.size[number] > criteria.own_part)
    column = readings[observed[:, number], number]
    return bool(root_mean_square(parts.own)[number] > criteria.own_part_alone * column.std())


def _explained(
    parts: OwnParts,
    effects: Sequence[FloatArray],
    number: int,
    channels: list[int],
    criteria: ChannelCriteria,
) -> bool:
    """Whether an effect of the structure explains a channel's own part, the others with it."""
    usual = np.where(np.isfinite(parts.usual), parts.usual, root_mean_square(parts.own))
    weight = 1 / np.maximum(usual[channels], 1e-300)
    place = channels.index(number)
    left = parts.left[:, channels] * weight
    before = float((left[:, place] ** 2).sum())
    for change in effects:
        shown = change[:, channels] * weight
        power = float((shown**2).sum())
        if power > 0:
            rest = left[:, place] - float((shown * left).sum()) / power * shown[:, place]
            if float((rest**2).sum()) < (1 - criteria.explained) * before:
                return True
    return False


def _erratic(
    model: Model,
    sensor: str,
    parts: OwnParts,
    observed: BoolArray,
    basis: FloatArray,
    simulated: FloatArray,
    number: int,
    onsets: bool,
    criteria: ChannelCriteria,
) -> BrokenChannel | None:
    """A channel of its own ways over the record."""
    seen = observed[:, number]
    count = int(seen.sum())
    if not np.isfinite(parts.usual[number]):
        why = "neither the loads nor other channels explain how it varies"
        return BrokenChannel(sensor, "erratic", why, count)
    change = _changed(parts.left[seen, number], basis[seen], simulated[seen, number], onsets)
    left = parts.left.copy()
    left[seen, number] = change.rest
    unchanged = replace(parts, left=left, own=beyond_others(left, observed))
    rest, size = unchanged.own[seen, number], float(unchanged.size[number])
    usual = float(unchanged.allowed[number])
    if size <= criteria.own_part:
        if abs(change.jump) <= criteria.largest_jump * offset_scale(model, sensor):
            return None
        unit = model.sensors[sensor].unit
        why = f"it jumps by {change.jump:.3g} {unit} in row {change.row + 1}"
        begun = change.row >= PARTS[0] * count
        row = int(np.flatnonzero(seen)[change.row]) if begun else None
        return BrokenChannel(sensor, "erratic", why, count - change.row, row)
    left[seen, number] = change.straight
    straight = replace(parts, left=left, own=beyond_others(left, observed))
    kept = float((change.straight**2).sum()) / float((change.rest**2).sum())
    if straight.size[number] <= criteria.own_part and kept < 1 - criteria.explained:
        return None
    largest = criteria.own_part * usual
    far = np.abs(rest) > 2 * largest
    if far.mean() < criteria.spiking_share and robust_deviation(rest[~far]) < largest:
        why = f"{far.mean():.1%} of its readings jump away from what loads and channels predict"
        return BrokenChannel(sensor, "spiking", why, max(int(far.sum()), 1))
    why = f"it leaves what loads and other channels predict by {size:.1f} times its usual noise"
    return BrokenChannel(sensor, "erratic", why, count)


def _working_until(
    model: Model,
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    basis: FloatArray,
    simulated: FloatArray,
    criteria: ChannelCriteria,
) -> NDArray[np.int64]:
    """Rows over which each channel works before it breaks, int[sensors]; 0: too few."""
    rows = len(readings)
    until = np.zeros(len(sensors), dtype=np.int64)
    for share in PARTS:
        end = int(share * rows)
        first = slice(0, end)
        parts = own_parts(
            model, sensors, readings[first], observed[first], basis[first], simulated[first]
        )
        until[parts.size <= criteria.works] = end
    return until


@dataclass(frozen=True)
class _Change:
    """The moment at which an own part changes most, and what the change does not explain.

    Attributes:
        row: number of the reading.
        jump: of the level there.
        rest: float[readings].
        straight: the same beside the square of what the channel should read and what lags behind
            it, float[readings]: a gauge that works goes with these on a member that softens, or
            slips with friction.
    """

    row: int
    jump: float
    rest: FloatArray
    straight: FloatArray


def _changed(own: FloatArray, basis: FloatArray, simulated: FloatArray, onsets: bool) -> _Change:
    """An own part less the level, the slope and the response that change most at some row.

    That much a drift, a jump, or a member that gives way may do. Where onsets are not looked for,
    that is a slope over the record.
    """
    rows = len(own)
    clock = np.arange(rows)
    courses = basis[:, : rows // ROWS_PER_COURSE]
    always = np.column_stack([np.ones(rows), clock / rows, courses])
    few = np.column_stack([simulated, basis[:, : rows // ROWS_PER_CHANGE]])
    scaled = (simulated - simulated.mean()) / max(float(simulated.std()), 1e-300)

    def design(row: int) -> FloatArray:
        if not onsets:
            return always
        slope = np.maximum(clock - row, 0) / rows
        later = (clock >= row)[:, None] * np.column_stack([np.ones(rows), slope, few])
        return np.hstack([always, later])

    def fitted(row: int) -> tuple[FloatArray, FloatArray]:
        weights = np.asarray(np.linalg.lstsq(design(row), own, rcond=None)[0], dtype=float)
        return weights, own - design(row) @ weights

    def beside(row: int, curve: FloatArray) -> FloatArray:
        known = np.hstack([design(row), curve])
        return np.asarray(own - known @ np.linalg.lstsq(known, own, rcond=None)[0])

    def left(row: int) -> float:
        return float((fitted(row)[1] ** 2).sum())

    best = 0
    if onsets:
        first, last = int(MARGIN * rows), int((1 - MARGIN) * rows)
        step = max(1, (last - first) // MOMENTS)
        best = min(range(first, last + 1, step), key=left)
        best = min(range(max(first, best - step), min(last, best + step) + 1), key=left)
    weights, rest = fitted(best)
    lagging = play(np.tile(scaled[:, None], len(PLAY)), np.array(PLAY))
    curves = [np.column_stack([scaled**2, one]) for one in lagging.T]
    straight = min((beside(best, curve) for curve in curves), key=lambda one: float(one @ one))
    return _Change(best, float(weights[always.shape[1]]) if onsets else 0.0, rest, straight)


def _lone(far: BoolArray, longest: int) -> BoolArray:
    """Those that stand alone or in short runs: what stays away has moved, and is no spike."""
    edges = np.flatnonzero(np.diff(far.astype(int), prepend=0, append=0))
    lone = far.copy()
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        lone[first:end] = end - first <= longest
    return lone
