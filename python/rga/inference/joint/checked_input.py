"""What a joint inference is given, as arrays of the right shape, or one clear error."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.joint.measured_contexts import BEYOND, MeasuredContexts
from rga.inference.joint.structural_parameters import Unknowns
from rga.inference.rows import Rows
from rga.model import Model

#: a reading may be so many times the widest range of a sensor, and spreads of its noise, away from
#: what the model simulates
FAR, FAR_NOISE = 3.0, 100.0
PLACE = "joint inference"


def joint_rows(
    unknowns: Unknowns, readings: FloatArray, source: FloatArray, load_tests: Rows | None
) -> tuple[FloatArray, FloatArray, Rows | None]:
    """Readings, source and load tests as arrays of the right shape.

    Raises:
        InputError: they are not, or there is nothing to infer.
    """
    sensors, contexts = len(unknowns.model.sensors), len(unknowns.model.context)
    if not contexts:
        raise InputError("the model has no context to infer", PLACE, "give it some")
    readings = table_of("readings", readings, sensors)
    source = table_of("source", source, contexts, whole=True)
    if not np.isfinite(readings).any() or len(source) == 0:
        raise InputError("there is no row to infer from", PLACE, "give some")
    if load_tests is None:
        return readings, source, None
    known = table_of("contexts of load tests", load_tests.contexts, contexts, whole=True)
    tested = table_of("readings of load tests", load_tests.readings, sensors)
    if len(known) != len(tested):
        problem = f"there are {len(tested)} rows of readings and {len(known)} of contexts"
        raise InputError(problem, "load tests", "give both of each")
    return readings, source, Rows(known, tested)


def table_of(name: str, given: FloatArray, columns: int, whole: bool = False) -> FloatArray:
    """An array of so many columns, all of it finite where it is to be whole.

    Raises:
        InputError: it is not.
    """
    table = _numbers(name, given)
    if table.ndim != 2 or table.shape[1] != columns:
        problem = f"{name} have the shape {list(table.shape)}"
        raise InputError(problem, PLACE, f"give float[rows, {columns}]")
    if whole and not np.isfinite(table).all():
        raise InputError(f"{name} are not all finite", PLACE, "leave such rows out")
    return table


def _numbers(name: str, given: FloatArray) -> FloatArray:
    try:
        found = np.asarray(np.ma.filled(given, np.nan))
        if found.dtype.kind not in "iuf":
            raise TypeError
    except (TypeError, ValueError):
        raise InputError(f"{name} are no numbers", PLACE, "give an array of floats") from None
    return found.astype(float)


def instruments(measured: MeasuredContexts | None, rows: int, model: Model) -> MeasuredContexts:
    """What instruments read of the contexts of so many rows; None: nothing.

    Raises:
        InputError: tables of another shape, a noise that is not above 0, or a value far from the
            range of its context.
    """
    contexts = len(model.context)
    if measured is None:
        return MeasuredContexts.none(rows, contexts)
    if not isinstance(measured, MeasuredContexts):
        remedy = "give MeasuredContexts.of(values, noise, ranges)"
        raise InputError("measured contexts are of another kind", PLACE, remedy)
    values = table_of("measured contexts", measured.values, contexts)
    noise = _numbers("standard deviations of measured contexts", measured.noise)
    if len(values) != rows:
        problem = f"there are {rows} rows of readings and {len(values)} of measured contexts"
        raise InputError(problem, PLACE, "give one row of them for each of readings")
    if noise.shape != (contexts,) or not (np.isfinite(noise) & (noise > 0)).all():
        remedy = f"give {contexts} standard deviations above 0, or MeasuredContexts.of"
        raise InputError("the noise of measured contexts is not known", PLACE, remedy)
    low, high = np.array([one.range for one in model.context.values()]).T
    reach = BEYOND * (high - low)
    far = np.isfinite(values) & ((values < low - reach) | (values > high + reach))
    if far.any():
        row, column = (int(one[0]) for one in np.nonzero(far))
        name = list(model.context)[column]
        raise InputError(
            f"context {name!r} reads {values[row, column]:g}, and its range is "
            f"{low[column]:g} to {high[column]:g}",
            f"{PLACE}, row {row + 1}",
            "give NaN where nothing was measured, and contexts in the units of the model",
        )
    return MeasuredContexts(np.where(np.isfinite(values), values, np.nan), noise)


def joint_noise(unknowns: Unknowns, noise: FloatArray) -> FloatArray:
    """Standard deviations of the sensors, above 0.

    Raises:
        InputError: they are not.
    """
    sensors, found = len(unknowns.model.sensors), _numbers("standard deviations", noise)
    if found.shape != (sensors,) or not (np.isfinite(found) & (found > 0)).all():
        remedy = f"give {sensors} standard deviations above 0"
        raise InputError("the noise of the sensors is not known", PLACE, remedy)
    return found


def check_plausible(unknowns: Unknowns, readings: FloatArray, noise: FloatArray) -> None:
    """A logger's mark for a reading that is missing would spoil all that is found.

    Raises:
        InputError: a reading is far from what the model simulates.
    """
    low, high, reach = _simulated(unknowns, noise)
    far = _outside(readings, low - reach, high + reach)
    if far.any():
        row, sensor = (int(one[0]) for one in np.nonzero(far))
        name = list(unknowns.model.sensors)[sensor]
        raise InputError(
            f"sensor {name!r} reads {readings[row, sensor]:g}, and the model simulates "
            f"{low[sensor]:.3g} to {high[sensor]:.3g}",
            f"{PLACE}, row {row + 1}",
            "give NaN where nothing was measured, and readings in the units of the sensors",
        )


def plausible(unknowns: Unknowns, readings: FloatArray, noise: FloatArray) -> FloatArray:
    """Readings, float[n, sensors], NaN where one is far from what the model simulates."""
    low, high, reach = _simulated(unknowns, noise)
    return np.where(_outside(readings, low - reach, high + reach), np.nan, readings)


def _outside(readings: FloatArray, low: FloatArray, high: FloatArray) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        far = (readings < low) | (readings > high)
    return np.asarray(far & np.isfinite(readings))


def _simulated(unknowns: Unknowns, noise: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Smallest and largest reading simulated, and how far beyond one may lie, float[sensors]."""
    simulated = unknowns.predict(unknowns.spread_contexts, unknowns.centre)
    low, high = simulated.min(axis=0), simulated.max(axis=0)
    units = np.array([sensor.unit for sensor in unknowns.model.sensors.values()])
    widest = np.array([(high - low)[units == one].max() for one in units])
    return low, high, FAR * widest + FAR_NOISE * noise
