"""Zeros of the logger that nobody declared, or that it took again on the way.

What a cause in the structure would show like a zero is told as well: a diagnosis tells them apart.
"""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding
from rga.checking.measured import Measured
from rga.checking.of_record.codes import codes
from rga.diagnosis.preparation.zeros.levels import Compared
from rga.diagnosis.preparation.zeros.restarted import jump_of_many
from rga.diagnosis.preparation.zeros.undeclared_zeros import off_by_constants
from rga.diagnosis.preparation.zeros.zero_rows import zero_rows
from rga.diagnosis.preparation.zeros.zeroed_again import zero_from

WHERE = "zeros of the record"
APART = "look into the log book; give the rows before and after as two records where it was so"
DECLARE = (
    'where the logger took them off declare it: zero = [from, to] in import.toml, or "zero" of the '
    "sensors in the model"
)


def zeros(measured: Measured) -> Iterator[Finding]:
    """Channels that jump together, read zero again, or are off by constants.

    Where contexts had to be guessed nothing is told: they would take up what zeros do. Nor is it
    where numbers stand for missing values: as readings they look like jumps and zeros.
    """
    data = measured.data
    if data.belief.inferred or not data.sensors or any(codes(measured)):
        return
    compared = Compared.of(measured.model, measured.over.simulator, data)
    row, jump = zero_from(compared), jump_of_many(compared)
    if row is not None:
        what = f"the channels read zero again from {_moment(measured, row)} on"
        yield Finding("warning", WHERE, f"{what}, as a logger does that is zeroed anew", APART)
    elif jump is not None:
        yield Finding(
            "warning",
            WHERE,
            f"{jump.jumping.sum()} of {len(jump.jumping)} channels jump together at "
            f"{_moment(measured, jump.row)}, by up to {compared.sizes(jump.size, jump.jumping)}, "
            "and stay off: a logger that was started anew, or a change of the structure",
            APART,
        )
    elif not len(data.tare):
        yield from _undeclared(measured, compared)


def _undeclared(measured: Measured, compared: Compared) -> Iterator[Finding]:
    offset, taken = off_by_constants(compared), zero_rows(compared)
    if taken is not None and (taken.surely or offset is not None):
        first, last = (_moment(measured, row) for row in (taken.first, taken.last))
        span = ", ".join(f"{measured.few.time[row]:.12g}" for row in (taken.first, taken.last))
        yield Finding(
            "warning",
            WHERE,
            f"the channels read zero on average from {first} to {last}, where the model says that "
            "they should not: most likely they were set to zero there",
            f"declare it: zero = [{span}] in import.toml",
        )
    elif offset is not None:
        off = np.abs(offset) > measured.criteria.zeros.offset
        yield Finding(
            "warning",
            WHERE,
            f"{off.sum()} of {len(off)} channels are off by constants, by up to "
            f"{compared.sizes(offset * compared.noise, off)}: they start from zeros of their own, "
            "or something acts that the model lacks",
            DECLARE,
        )


def _moment(measured: Measured, row: int) -> str:
    """The time of one of the rows that are looked at."""
    label = measured.few.time_label(float(measured.few.time[row]))
    return label if isinstance(label, str) else f"{label:.12g} s"
