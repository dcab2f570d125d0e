"""Zeros that nobody declared: channels that start from values of their own, or are zeroed again.

A logger without a tare shows every channel from a zero of its own. Then nothing but changes can be
compared, and the record is taken as zeroed over all of its rows. A logger that is zeroed again in
mid-record starts anew there: the longer part is kept. Both are reported. Where contexts have to be
inferred the readings are taken as they are.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.search.hypothesis import hypotheses
from rga.diagnosis.search.signatures import signatures
from rga.model.schema import Model
from rga.numerics.decompositions import thin_svd
from rga.records import Record
from rga.simulation import Simulator

#: rows over which the logger may have taken its zero, and over which levels are compared
TAKEN, BESIDE = (1, 2, 5, 10), 10


def with_own_zeros(
    model: Model, simulator: Simulator, record: Record, data: Data
) -> tuple[Record, list[str]]:
    """The record with zeros that can be compared, and what was done, in words.

    Args:
        model: as it was given.
        simulator: of it.
        record: as it was measured.
        data: of all its rows.
    """
    if data.belief.inferred:
        return record, []
    simulated = data.predict(simulator)
    noise = _noise(np.where(data.observed, data.readings - simulated, np.nan))
    stated = np.array([model.sensors[name].noise or np.inf for name in data.sensors])
    again = _zeroed_again(data, simulated, noise, np.minimum(stated, noise))
    if again is not None and not _one_cause(model, simulator, data, simulated, noise, again):
        return _longer_part(record, again)
    if not len(data.tare) and _start_anywhere(model, simulator, data, simulated, noise):
        warning = (
            "the readings start from zeros of their own: offsets of all channels are taken as "
            "unknown, and the record as zeroed over all of its rows"
        )
        return _zeroed(record, np.ones(len(record), dtype=bool)), [warning]
    return record, []


def _noise(residual: FloatArray) -> FloatArray:
    """Robust deviation of each channel's noise, by what changes from row to row, float[sensors]."""
    steps = np.abs(np.diff(residual, axis=0))
    typical = [np.median(one[np.isfinite(one)]) if np.isfinite(one).any() else 0 for one in steps.T]
    return np.asarray(1.4826 / np.sqrt(2) * np.array(typical, dtype=float))


# --- No zero at all -------------------------------------------------------------------------------


def _start_anywhere(
    model: Model, simulator: Simulator, data: Data, simulated: FloatArray, noise: FloatArray
) -> bool:
    """Whether most channels are off by constants that no few causes make."""
    criteria = data.criteria.zeros
    constant = _constant(simulator, data)
    working = noise > 0
    least = max(criteria.fewest_channels, criteria.share_of_channels * working.sum())

    def offsets(values: FloatArray) -> FloatArray:
        seen = np.where(data.observed, constant[:, None], 0.0)
        own = np.maximum((seen * constant[:, None]).sum(0), 1e-300)
        return np.where(working, (seen * values).sum(0) / own / np.where(working, noise, 1.0), 0.0)

    left = offsets(np.where(data.observed, data.readings - simulated, 0.0))
    if (np.abs(left) > criteria.offset).sum() < least:
        return False
    whole = float(left @ left)
    patterns = [offsets(change) for change, _ in _changes(model, simulator, data)]
    rest = np.array([one for one in patterns if one.any()]).reshape(-1, len(left))
    for _ in range(min(criteria.most_causes, len(rest))):
        sizes = (rest**2).sum(1)
        along = rest @ left / np.sqrt(np.maximum(sizes, 1e-300))
        best = rest[np.argmax(np.abs(along))] / np.sqrt(sizes[np.argmax(np.abs(along))])
        left = left - best * (best @ left)
        rest = rest - np.outer(rest @ best, best)
        rest = rest[(rest**2).sum(1) > 1e-6 * sizes]
        if not len(rest):
            break
    many = (np.abs(left) > criteria.offset).sum() >= least
    return bool(many and left @ left > criteria.left_by_causes * whole)


def _changes(
    model: Model, simulator: Simulator, data: Data
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """What causes of the structure change, float[rows, sensors], and what a late one adds.

    The latter, float[sensors], is what the zero takes off one that always acts.
    """
    candidates = [
        one
        for one in hypotheses(model, data.sensors, list(data.belief.spread))
        if not one.kind.on_sensors
    ]
    for found in signatures(data, data.about(simulator), candidates):
        touched = slice(None) if found.channels is None else found.channels
        change, late = np.zeros((len(data.time), len(data.sensors))), np.zeros(len(data.sensors))
        change[:, touched], late[touched] = found.values.T, found.zero
        yield change, late


def _constant(simulator: Simulator, data: Data) -> FloatArray:
    """A constant, less what the time histories of the loads have of it, float[rows]."""
    loads = simulator.load_coefficients(data.belief.table)
    u, s, _ = thin_svd(loads)
    courses = u[:, s > 1e-6 * s.max(initial=0.0)]
    ones = np.ones(len(data.time))
    rest = ones - courses @ (courses.T @ ones)
    # Under loads that hardly vary no constant can be distinguished from their response.
    return rest if rest @ rest > 1e-3 * len(rest) else ones


# --- Zeroed again ---------------------------------------------------------------------------------


def _zeroed_again(
    data: Data, simulated: FloatArray, noise: FloatArray, own: FloatArray
) -> int | None:
    """The row from which on the channels start from zero again, if there is one.

    Args:
        data: of all rows.
        simulated: float[rows, sensors].
        noise: of the residual of each channel from row to row, float[sensors].
        own: noise of each sensor itself, float[sensors].
    """
    criteria = data.criteria.zeros
    least = max(criteria.fewest_channels, criteria.share_of_channels * (noise > 0).sum())
    readings = np.where(data.observed, data.readings, np.nan)
    expected = np.where(data.observed, simulated, np.nan)
    over = _moving_means(readings - expected, BESIDE)
    rows = np.arange(BESIDE, len(over))
    before, after = over[rows - BESIDE], over[rows]
    shift = noise * np.sqrt(2 / BESIDE)
    found = np.zeros(len(rows), dtype=bool)
    for taken in TAKEN:
        shown = _moving_means(readings, taken)[rows]
        should = _moving_means(expected, taken)[rows] + before
        far = np.maximum(criteria.far_from_zero * shift, criteria.offset * own)
        telling = (np.abs(should) > far) & (noise > 0)
        zero = telling & (np.abs(shown) <= criteria.near_zero * own)
        missed = criteria.shift_share * np.abs(should) + criteria.shift_deviations * shift
        zero &= np.abs(after - before + should) <= missed
        enough = telling.sum(1) >= least
        found |= enough & (zero.sum(1) >= criteria.reading_zero * telling.sum(1))
    if not found.any():
        return None
    # Rows beside it may read near zero too: where it happened the levels lie furthest apart.
    apart = np.nansum(np.abs(after - before) / np.where(noise > 0, shift, np.inf), axis=1)
    return int(rows[np.argmax(np.where(found, apart, -1.0))])


def _one_cause(
    model: Model,
    simulator: Simulator,
    data: Data,
    simulated: FloatArray,
    noise: FloatArray,
    row: int,
) -> bool:
    """Whether a single cause that begins at a row makes the jump of all channels there."""
    working = noise > 0
    residual = np.where(data.observed, data.readings - simulated, np.nan)
    beside = residual[row - BESIDE : row], residual[row : row + BESIDE]
    before, after = (_moving_means(part, len(part))[0] for part in beside)
    jump = np.where(working, np.nan_to_num(after - before) / np.where(working, noise, 1.0), 0.0)
    for change, late in _changes(model, simulator, data):
        pattern = change[row : row + BESIDE].mean(0) + late
        shown = np.where(working, pattern / np.where(working, noise, 1.0), 0.0)
        alike = (shown @ jump) ** 2
        if alike > data.criteria.zeros.one_cause * (shown @ shown) * (jump @ jump):
            return True
    return False


def _moving_means(values: FloatArray, width: int) -> FloatArray:
    """Means over so many rows from each row on, NaN where there is none, float[rows, sensors]."""
    seen = np.isfinite(values)
    none = np.zeros((1, values.shape[1]))
    total = np.cumsum(np.concatenate([none, np.where(seen, values, 0.0)]), axis=0)
    count = np.cumsum(np.concatenate([none, seen]), axis=0)
    total, count = total[width:] - total[:-width], count[width:] - count[:-width]
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _longer_part(record: Record, row: int) -> tuple[Record, list[str]]:
    rows = np.arange(len(record))
    later = row < len(record) - row
    kept = rows >= row if later else rows < row
    part = replace(record, readings=np.where(kept[:, None], record.readings, np.nan))
    warning = (
        f"all channels read zero again from {record.time_label(float(record.time[row]))} on: the "
        f"logger was zeroed anew, and only what comes {'after' if later else 'before'} is used"
    )
    return _zeroed(part, kept) if later else part, [warning]


def _zeroed(record: Record, rows: BoolArray) -> Record:
    """The record less the mean of each channel over rows."""
    mean = np.nan_to_num(_moving_means(record.readings[rows], int(rows.sum()))[0])
    first, last = record.time[rows][[0, -1]]
    return replace(record, readings=record.readings - mean, zero=(float(first), float(last)))
