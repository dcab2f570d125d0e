"""From a record to the data that a diagnosis works on: rows, channels, contexts."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rga.diagnosis.channels import Fault, find_faults, lone_spikes
from rga.diagnosis.data import Data, first_belief
from rga.diagnosis.latent import guess_lines, guess_rows
from rga.diagnosis.problem import load_basis
from rga.diagnosis.row_covariance import BoolArray
from rga.errors import InputError
from rga.model.parameter import FloatArray
from rga.model.schema import Model
from rga.records import Record
from rga.simulation import Simulator

#: rows that are analysed at most; more are thinned evenly
MOST_ROWS = 800
LEAST_ROWS = 12
FEW_ROWS = 60
#: correlation with the simulation beyond which a channel tells its unit, and how much larger or
#: smaller readings are that look like another unit
ALIKE, OTHER_UNIT = 0.8, 30.0
#: share of the record that a context repeats its last value for, and is doubted
STILL = 0.1


@dataclass(frozen=True)
class Prepared:
    """A record made ready.

    Attributes:
        data: of all rows that are analysed.
        record: the same rows of the record, its working and its rejected channels.
        chosen: bool[rows of the record], the rows that are analysed.
        faults: channels that do not work; the data leave them out.
        warnings: in words.
    """

    data: Data
    record: Record
    chosen: BoolArray
    faults: list[Fault]
    warnings: list[str]


def prepare(model: Model, record: Record, progress: Callable[[float], None]) -> Prepared:
    """Choose rows, reject channels that do not work, and guess the latent contexts.

    Raises:
        InputError: too few rows, or no channel that works.
    """
    check_length(record)
    simulator = Simulator(model)
    data = _data(model, record)
    stuck = find_faults(data.sensors, data.readings, data.observed)
    data = _without(data, stuck)
    data = guess_lines(simulator, data, progress)
    chosen = _loaded_rows(simulator, data)
    data = guess_rows(simulator, data.rows(chosen))
    basis = load_basis(simulator, data)
    simulated = data.predict(simulator)
    doubts = _doubts(model, data, simulated, record)
    broken = find_faults(data.sensors, data.readings, data.observed, simulated, basis)
    data = _without(data, broken)
    if not data.sensors:
        fault = [*stuck, *broken][0]
        raise InputError(
            "none of the channels works",
            f"record; of {fault.sensor!r}, {fault.why}",
            "check the record and the mapping",
        )
    spikes = lone_spikes(data.readings, data.observed, load_basis(simulator, data))
    warnings = [*record.warnings, *doubts]
    if chosen.sum() < FEW_ROWS:
        warnings.append(f"only {int(chosen.sum())} rows: noise and intervals are rough estimates")
    if passing := data.belief.passing:
        warnings.append(
            f"onsets were not looked for: {', '.join(passing)} passes once, and what depends on it "
            "cannot be told from what begins on the way"
        )
    silent = int((~data.observed.any(1)).sum())
    if silent:
        warnings.append(f"{silent} rows without a context or without any reading were left aside")
    if spikes.any():
        warnings.append(f"{int(spikes.sum())} lone spikes were taken as missing readings")
        data = replace(data, observed=data.observed & ~spikes)
    return Prepared(data, record.rows(chosen), chosen, [*stuck, *broken], warnings)


def _doubts(model: Model, data: Data, simulated: FloatArray, record: Record) -> list[str]:
    """What looks like a slip with units, or a context that is measured no more."""
    told = []
    readings = np.where(data.observed, data.readings, np.nan)
    factors = [
        float(np.nanstd(own) / shown.std())
        for own, shown in zip(readings.T, simulated.T, strict=True)
        if shown.std() > 0 and abs(_correlation(own, shown)) > ALIKE
    ]
    if len(factors) > data.readings.shape[1] / 2:
        factor = float(np.median(factors))
        if not 1 / OTHER_UNIT < factor < OTHER_UNIT:
            told.append(
                f"the readings go with the simulation and are about {factor:.2g} times as large: "
                "check the units of record and model before any cause"
            )
    for name in data.belief.spread:
        column = record.contexts.get(name)
        if column is None:
            continue
        low, high = model.context[name].range
        if ((column < low) | (column > high)).all():
            told.append(
                f"{name} lies outside its range {low:g}..{high:g} in every row: check its unit and "
                "its zero before any cause"
            )
        last = int((column[::-1] == column[-1]).argmin() if (column != column[-1]).any() else 0)
        if last > STILL * len(column):
            told.append(
                f"{name} reads {column[-1]:g} exactly in the last {last} of {len(column)} rows: "
                "check its sensor before any cause"
            )
    return told


def _correlation(own: FloatArray, shown: FloatArray) -> float:
    seen = np.isfinite(own)
    if seen.sum() < LEAST_ROWS or np.ptp(own[seen]) == 0 or np.ptp(shown[seen]) == 0:
        return 0.0
    return float(np.corrcoef(own[seen], shown[seen])[0, 1])


def check_length(record: Record) -> None:
    """Refuse a record that is too short for a diagnosis (InputError)."""
    if len(record) < LEAST_ROWS:
        raise InputError(
            f"the record has {len(record)} rows",
            "record",
            f"a diagnosis needs {LEAST_ROWS} at least",
        )


def _data(model: Model, record: Record) -> Data:
    order = {name: number for number, name in enumerate(model.sensors)}
    belief = first_belief(model, record.origin + record.time, record.contexts)
    # A row whose context is missing cannot be simulated: its readings are left aside.
    told = [np.isfinite(record.contexts[n]) for n in belief.spread if n in record.contexts]
    complete = np.all(told, axis=0) if told else np.ones(len(record.time), dtype=bool)
    leading = record.zero_rows()
    return Data(
        sensors=tuple(record.sensors),
        columns=[order[name] for name in record.sensors],
        readings=np.nan_to_num(record.readings),
        observed=np.isfinite(record.readings) & complete[:, None],
        belief=belief,
        zero={name: column[leading] for name, column in belief.table.items()},
    )


def _without(data: Data, faults: list[Fault]) -> Data:
    broken = {fault.sensor for fault in faults}
    kept = [number for number, name in enumerate(data.sensors) if name not in broken]
    return replace(
        data,
        sensors=tuple(data.sensors[number] for number in kept),
        columns=[data.columns[number] for number in kept],
        readings=data.readings[:, kept],
        observed=data.observed[:, kept],
    )


def _loaded_rows(simulator: Simulator, data: Data) -> BoolArray:
    """Rows that are analysed: without long unloaded ends, thinned evenly to a bounded number."""
    rows = len(data.time)
    first, last = 0, rows - 1
    if data.belief.lines:
        # Rows before and after a crossing say nothing of the structure; a little of them is kept.
        acting = np.flatnonzero(_acting(simulator.load_coefficients(data.belief.table)))
        if len(acting):
            margin = max(2, len(acting) // 25)
            first, last = max(0, acting[0] - margin), min(rows - 1, acting[-1] + margin)
    step = -(-(last - first + 1) // MOST_ROWS)
    chosen = np.zeros(rows, dtype=bool)
    chosen[first : last + 1 : step] = True
    return chosen


def _acting(coefficients: FloatArray) -> BoolArray:
    return np.asarray((np.abs(coefficients) > 0).any(1))
