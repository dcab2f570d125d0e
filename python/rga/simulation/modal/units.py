"""Whether the modes of a record are in the units, and on the scale, of those expected."""

from collections.abc import Mapping, Sequence

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.schema import Model
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.expected import Expected, mac
from rga.simulation.modal.windows import NamedModes

#: what stands for Hz by mistake, over what it would be in Hz
OTHER_UNITS = {
    "rad/s": 2 * np.pi,
    "cycles per minute": 60.0,
    "Hz divided by 60": 1 / 60,
    "kHz": 1e-3,
    "rad/ms": 2e-3 * np.pi,
}
#: factor by which no structure that is still that of the model has all of its modes off; and the
#: same where a frequency is one by so little: of those that are normalised one is
FAR, OFF, ONE = 2.5, 1.25, 0.01
#: share of the entries that a unit must explain, and by how much it may be off
MOST, NEAR = 0.8, 0.1
#: share of the entries that are modes as they are, below which another unit is looked for
FEW = 0.5
#: MAC with the sizes of a mode alone, and how much less with its signs, of a shape that lost them
SAME, LESS = 0.95, 0.05


def check_units(
    named: NamedModes, record: ModalRecord, expected: Mapping[str, Expected], model: Model
) -> None:
    """Refuse a record of which nothing is expected, or all on another scale.

    Args:
        named: which modes the entries are.
        record: of them.
        expected: modes, by name.
        model: of the structure.

    Raises:
        InputError: no mode is in the record; all are faster or slower than expected by much, as in
            another unit or normalised; or shapes have sizes and no signs.
    """
    where = f"modes {', '.join(expected)} of model {model.name!r}"
    looks = list(expected.values())
    if _without_signs(record, looks, list(model.points)):
        raise InputError(
            "the shapes have sizes, and no signs: two parts that move against each other move "
            "together in them",
            where,
            "give real and imaginary parts, not amplitudes",
        )
    own = named.mode >= 0
    unit = _unit_of(record.frequency, looks) if own.mean() < FEW else None
    if unit or not own.any():
        guess = f": they look like {unit}, give them in Hz" if unit else ""
        few = f"{own.sum()} of {len(own)} entries are modes" if own.any() else "none of the modes"
        raise InputError(
            f"{few} that the model expects" + ("" if own.any() else " is in the record"),
            f"{where}; frequencies of the record {_range(record.frequency)} Hz{guess}",
            "compare the frequencies and shapes of the record with `near`, `within` and `shape` "
            "of the modes, and the names of the points",
        )
    found = [number for number in range(len(looks)) if (named.mode == number).any()]
    medians = np.array([np.median(record.frequency[named.mode == number]) for number in found])
    ratios = medians / [looks[number].near for number in found]
    far = OFF if (np.abs(medians - 1.0) < ONE).any() else FAR
    if len(found) > 1 and ((ratios > far).all() or (ratios < 1.0 / far).all()):
        raise InputError(
            f"every mode that was found is {_range(ratios)} times as fast as it is expected",
            where,
            "give frequencies in Hz, not normalised; where they are, mend `near` of the modes",
        )


def _range(values: FloatArray) -> str:
    low, high = (f"{one:.3g}" for one in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _unit_of(frequency: FloatArray, looks: list[Expected]) -> str | None:
    """The unit in which frequencies would be those expected."""
    near = np.log([look.near for look in looks])
    for unit, size in OTHER_UNITS.items():
        off = np.abs(np.log(frequency / size)[:, None] - near).min(axis=1)
        if (off < NEAR).mean() >= MOST:
            return unit
    off = np.abs(-np.log(frequency)[:, None] - near).min(axis=1)
    return "periods in s" if (off < NEAR).mean() >= MOST else None


def _without_signs(record: ModalRecord, looks: Sequence[Expected], points: list[str]) -> bool:
    """Whether no entry has a sign, and some have the sizes of a mode that has two."""
    if not record.points or (record.shapes < 0.0).any():
        return False
    shapes = np.full((len(record), len(points)), np.nan)
    shapes[:, [points.index(name) for name in record.points]] = record.shapes
    for look in looks:
        about = np.abs(np.log(record.frequency / look.near)) < look.within
        lost = [
            mac(one[seen], np.abs(own[seen])) > max(SAME, mac(one[seen], own[seen]) + LESS)
            for one in shapes[about][:, look.at]
            for own, seen in [(look.shape, np.isfinite(one))]
        ]
        if lost and np.mean(lost) > 0.5:
            return True
    return False
