"""What of a record looks like a slip: units that were mixed up, contexts that do not change."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.data.observations import Data
from rga.findings.criteria.records import RecordCriteria
from rga.findings.phrases import few_digits
from rga.model.schema import Model
from rga.records import Record

#: channels of a unit that show a slip of it
FEWEST_OF_A_UNIT = 2
#: factors that differ by less are of one slip
ALIKE = 3.0


@dataclass(frozen=True)
class UnitSlip:
    """Channels of some units that go with the simulation, but for a factor or the sign.

    Attributes:
        units: of these channels.
        words: what there is of it.
    """

    units: tuple[str, ...]
    words: str


def suspicious_units(model: Model, data: Data, simulated: FloatArray) -> list[str]:
    """Warnings where most channels of a unit go with the simulation, but for a factor or the sign.

    Args:
        model: has the sensors.
        data: of the rows that are analysed.
        simulated: float[rows, sensors].
    """
    return [slip.words for slip in unit_slips(model, data, simulated)]


def unit_slips(model: Model, data: Data, simulated: FloatArray) -> list[UnitSlip]:
    """The same with the units that they are of."""
    units = np.array([model.sensors[name].unit for name in data.sensors])
    factors, limits = unit_factors(data, simulated), data.criteria.record
    larger: dict[float, list[str]] = {}
    turned: list[str] = []
    for unit in dict.fromkeys(units.tolist()):
        own = factors[units == unit]
        known = own[np.isfinite(own)]
        if len(known) < FEWEST_OF_A_UNIT or len(known) <= len(own) / 2:
            continue
        factor = float(np.median(known))
        if of_a_unit(abs(factor), limits):
            alike = (one for one in larger if ALIKE > abs(factor) / one > 1 / ALIKE)
            larger.setdefault(next(alike, abs(factor)), []).append(unit)
        if factor < 0:
            turned.append(unit)
    slips = [
        UnitSlip(
            tuple(of),
            f"the readings in {' and '.join(of)} go with the simulation and are about "
            f"{few_digits(factor)} times as large: check the units of record and model before any "
            "cause",
        )
        for factor, of in larger.items()
    ]
    if turned:
        words = (
            f"the readings in {' and '.join(turned)} go against the simulation: check the sign "
            "convention of record and model before any cause"
        )
        slips.append(UnitSlip(tuple(turned), words))
    return slips


def doubted_units(data: Data, simulated: FloatArray) -> BoolArray:
    """Channels that go with the simulation, many times as large or as small, bool[sensors].

    Args:
        data: with their readings.
        simulated: float[rows, sensors].
    """
    limits = data.criteria.record
    factors = np.abs(unit_factors(data, simulated))
    return np.array([of_a_unit(one, limits) for one in factors], dtype=bool)


def unit_factors(data: Data, simulated: FloatArray) -> FloatArray:
    """Readings over simulation of channels that go with it, or against it, float[sensors]; NaN."""
    limits = data.criteria.record
    readings = np.where(data.observed, data.readings, np.nan)
    factors = np.full(len(data.sensors), np.nan)
    for number, (own, shown) in enumerate(zip(readings.T, simulated.T, strict=True)):
        together = _correlation(own, shown, limits)
        if abs(together) > limits.unit_correlation:
            factors[number] = np.sign(together) * np.nanstd(own) / shown.std()
    return factors


def of_a_unit(factor: float, limits: RecordCriteria) -> bool:
    """Whether so large a factor, or so small a one, is a matter of units; NaN is not."""
    return factor >= limits.unit_factor or factor <= 1 / limits.unit_factor


def _correlation(own: FloatArray, shown: FloatArray, limits: RecordCriteria) -> float:
    seen = np.isfinite(own)
    if seen.sum() < limits.least_rows or np.ptp(own[seen]) == 0 or np.ptp(shown[seen]) == 0:
        return 0.0
    return float(np.corrcoef(own[seen], shown[seen])[0, 1])


def suspicious_contexts(model: Model, data: Data, record: Record) -> list[str]:
    """Warnings of measured contexts that are out of range or do not change.

    Args:
        model: states their ranges.
        data: says which of them the simulation depends on.
        record: as it was measured.
    """
    measured = [name for name in data.belief.spread if name in record.contexts]
    return [
        words
        for name in measured
        for words in _doubts(name, record.contexts[name], model, data.criteria.record)
    ]


def _doubts(name: str, column: FloatArray, model: Model, limits: RecordCriteria) -> list[str]:
    low, high = model.context[name].range
    warnings = []
    if ((column < low) | (column > high)).all():
        warnings.append(
            f"{name} lies outside its range {low:g}..{high:g} in every row: check its unit and "
            "its zero before any cause"
        )
    known = column[np.isfinite(column)]
    if len(known) and low < high and np.ptp(known) == 0:
        warnings.append(
            f"{name} has one value, {known[0]:g}, in all rows: what it does cannot be seen, and if "
            "it was not measured leave it out of the record, so that it is inferred"
        )
    last = int((column[::-1] == column[-1]).argmin() if (column != column[-1]).any() else 0)
    if last > limits.still_share * len(column):
        warnings.append(
            f"{name} reads {column[-1]:g} exactly in the last {last} of {len(column)} rows: "
            "check its sensor before any cause"
        )
    return warnings
