"""Zeros that nobody declared: channels that start from values of their own, or are zeroed again.

A logger without a tare shows every channel from a zero of its own. Then nothing but changes can be
compared, and the record is taken as zeroed over all of its rows. A logger that is zeroed again or
started anew in mid-record begins anew there: the longer part is kept. All is reported. What leaves
more than one reading of the record is a doubt, and such a record is not called explained. Where
contexts have to be inferred the readings are taken as they are.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.zeros.levels import Compared, constant, left_by_causes, means_between
from rga.diagnosis.preparation.zeros.restarted import Jump, restarted
from rga.diagnosis.preparation.zeros.zero_rows import ZeroRows, zero_rows
from rga.diagnosis.preparation.zeros.zeroed_again import zeroed_again
from rga.model.schema import Model
from rga.records import Record
from rga.simulation import Simulator


@dataclass(frozen=True)
class OwnZeros:
    """A record with zeros that can be compared.

    Attributes:
        record: of which only changes are compared, or a part, where zeros were found.
        warnings: what was done, in words.
        doubts: why the record cannot be called explained before its zeros are known, in words.
    """

    record: Record
    warnings: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)


def with_own_zeros(model: Model, simulator: Simulator, record: Record, data: Data) -> OwnZeros:
    """The record with zeros that can be compared, and what was done.

    Args:
        model: as it was given.
        simulator: of it.
        record: as it was measured.
        data: of all its rows.
    """
    if data.belief.inferred:
        return OwnZeros(record)
    compared = Compared.of(model, simulator, data)
    row = zeroed_again(compared)
    if row is not None:
        return OwnZeros(_longer_part(record, row), [_again_words(record, row)])
    jump = restarted(compared)
    if jump is not None:
        part = _longer_part(record, jump.row)
        return OwnZeros(part, doubts=[_jump_words(compared, record, jump)])
    return OwnZeros(record) if len(data.tare) else _without_zero(compared, record)


def _without_zero(compared: Compared, record: Record) -> OwnZeros:
    """A record that declares no zero, taken as zeroed where its channels are off by constants."""
    taken = zero_rows(compared)
    anywhere = _anywhere(compared)
    if not anywhere and (taken is None or not _likeliest(compared, taken)):
        return OwnZeros(record)
    only_changes = _zeroed(record, np.ones(len(record), dtype=bool))
    if anywhere or taken is None:
        return OwnZeros(only_changes, [_anywhere_words(record, taken)])
    return OwnZeros(only_changes, doubts=[_taken_words(compared, record, taken)])


def off_by_constants(compared: Compared) -> FloatArray | None:
    """The constant in the residual of each channel, over the noise, where most have one."""
    criteria = compared.data.criteria.zeros
    least = compared.at_least(criteria.share_of_channels)
    offset = _offsets(compared, compared.residual)
    return None if (np.abs(offset) > criteria.offset).sum() < least else offset


def _anywhere(compared: Compared) -> bool:
    """Whether most channels are off by constants that no few causes make."""
    criteria = compared.data.criteria.zeros
    least = compared.at_least(criteria.share_of_channels)
    offset = off_by_constants(compared)
    if offset is None:
        return False
    left = left_by_causes(offset, _offsets_of_causes(compared), criteria.most_causes)
    many = (np.abs(left) > criteria.offset).sum() >= least
    return bool(many and left @ left > criteria.left_by_causes * (offset @ offset))


def _offsets_of_causes(compared: Compared) -> list[FloatArray]:
    few = compared.thinned()
    return [_offsets(few, change) for change, _ in few.changes()]


def _offsets(compared: Compared, values: FloatArray) -> FloatArray:
    """The constant in values beside the courses of the loads, over the noise, float[sensors]."""
    course = constant(compared.simulator, compared.data)[:, None]
    seen = np.where(compared.data.observed, course, 0.0)
    power = np.maximum((seen * course).sum(0), 1e-300)
    return compared.over_noise((seen * np.nan_to_num(values)).sum(0) / power)


def _likeliest(compared: Compared, taken: ZeroRows) -> bool:
    """Whether rows of zero are the likeliest reason of offsets that few causes might make too.

    A load that was measured with an offset may make readings of zero beside one that is not zero.
    """
    if taken.surely:
        return True
    offset = compared.over_noise(taken.taken)
    left = left_by_causes(offset, _offsets_of_causes(compared), 1)
    share = 1 - compared.data.criteria.zeros.one_cause
    return bool(left @ left > share * (offset @ offset))


# --- What is kept ---------------------------------------------------------------------------------


def _longer_part(record: Record, row: int) -> Record:
    """What comes before a row, or what comes after it, as zeroed over all of its rows."""
    rows = np.arange(len(record))
    later = _later(record, row)
    kept = rows >= row if later else rows < row
    part = replace(record, readings=np.where(kept[:, None], record.readings, np.nan))
    return _zeroed(part, kept) if later else part


def _later(record: Record, row: int) -> bool:
    return row < len(record) - row


def _zeroed(record: Record, rows: BoolArray) -> Record:
    """The record less the mean of each channel over rows."""
    first, end = np.flatnonzero(rows)[[0, -1]] + [0, 1]
    mean = np.nan_to_num(means_between(record.readings, first[None], end[None])[0])
    span = (float(record.time[first]), float(record.time[end - 1]))
    return replace(record, readings=record.readings - mean, zero=span)


# --- In words -------------------------------------------------------------------------------------


def _again_words(record: Record, row: int) -> str:
    return (
        f"all channels read zero again from {_moment(record, row)} on: the logger was zeroed anew, "
        f"and only what comes {'after' if _later(record, row) else 'before'} is used"
    )


def _jump_words(compared: Compared, record: Record, jump: Jump) -> str:
    to_zero = " to a reading of zero" if jump.at_zero else ""
    return (
        f"{jump.jumping.sum()} of {len(jump.jumping)} channels jump together at row {jump.row + 1} "
        f"({_moment(record, jump.row)}){to_zero}, by up to "
        f"{compared.sizes(jump.size, jump.jumping)}, and stay off from there on, as no few causes "
        "in the structure would make them: this looks like a logger that was started or set to "
        f"zero anew. Only what comes {'after' if _later(record, jump.row) else 'before'} is used. "
        "Look into the log book, and diagnose the rows before and after as two records, each with "
        "a zero of its own"
    )


def _anywhere_words(record: Record, taken: ZeroRows | None) -> str:
    words = (
        "the readings start from zeros of their own: offsets of all channels are taken as "
        "unknown, and the record as zeroed over all of its rows"
    )
    return words if taken is None else f"{words}; {_declare_words(record, taken)}"


def _taken_words(compared: Compared, record: Record, taken: ZeroRows) -> str:
    off = taken.taken != 0
    return (
        f"{off.sum()} of {len(off)} channels are off by a constant, by up to "
        f"{compared.sizes(taken.taken, off)}, and {_declare_words(record, taken)}. A load that was "
        "measured with an offset would show the same: offsets of all channels are taken as unknown "
        "here"
    )


def _declare_words(record: Record, taken: ZeroRows) -> str:
    first, last = record.time[[taken.first, taken.last]]
    span = f"[{first:.12g}, {last:.12g}]"
    return (
        f"they read zero on average over rows {taken.first + 1} to {taken.last + 1} "
        f"({_moment(record, taken.first)} to {_moment(record, taken.last)}), where the model says "
        "that they should not: most likely they were set to zero there. Declare this by "
        f"zero = {span} in import.toml, and diagnose again"
    )


def _moment(record: Record, row: int) -> str:
    label = record.time_label(float(record.time[row]))
    return label if isinstance(label, str) else f"{label:.12g} s"
