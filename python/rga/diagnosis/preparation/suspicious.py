"""What of a record looks like a slip: units that were mixed up, contexts that do not change."""

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.data.observations import Data
from rga.findings.criteria.records import RecordCriteria
from rga.findings.phrases import few_digits
from rga.model.schema import Model
from rga.records import Record

#: channels of a unit that show a slip of it
FEWEST_OF_A_UNIT = 2


def suspicious_units(model: Model, data: Data, simulated: FloatArray) -> list[str]:
    """Warnings where most channels of a unit go with the simulation, many times larger or smaller.

    Args:
        model: has the sensors.
        data: of the rows that are analysed.
        simulated: float[rows, sensors].
    """
    units = np.array([model.sensors[name].unit for name in data.sensors])
    factors = _unit_factors(data, simulated)
    typical: dict[str, float] = {}
    for unit in dict.fromkeys(units.tolist()):
        own = factors[units == unit]
        known = own[np.isfinite(own)]
        factor = float(np.median(known)) if len(known) > len(own) / 2 else np.nan
        if len(known) >= FEWEST_OF_A_UNIT and _of_a_unit(factor, data.criteria.record):
            typical[unit] = factor
    return [
        f"the readings in {unit} go with the simulation and are about {few_digits(factor)} times "
        "as large: check the units of record and model before any cause"
        for unit, factor in typical.items()
    ]


def doubted_units(data: Data, simulated: FloatArray) -> BoolArray:
    """Channels that go with the simulation, many times as large or as small, bool[sensors].

    Args:
        data: with their readings.
        simulated: float[rows, sensors].
    """
    limits = data.criteria.record
    return np.array([_of_a_unit(one, limits) for one in _unit_factors(data, simulated)], dtype=bool)


def _unit_factors(data: Data, simulated: FloatArray) -> FloatArray:
    """Readings over simulation of channels that go with it, float[sensors]; else NaN."""
    limits = data.criteria.record
    readings = np.where(data.observed, data.readings, np.nan)
    factors = [
        float(np.nanstd(own) / shown.std())
        if shown.std() > 0 and abs(_correlation(own, shown, limits)) > limits.unit_correlation
        else np.nan
        for own, shown in zip(readings.T, simulated.T, strict=True)
    ]
    return np.array(factors, dtype=float)


def _of_a_unit(factor: float, limits: RecordCriteria) -> bool:
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
