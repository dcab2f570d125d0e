"""Loading a measured record against a model."""

from pathlib import Path

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.model.units import UNITS, per_si
from rga.records.clock import read_clock
from rga.records.lead_in import find_lead_in
from rga.records.mapping import Channel, RecordMapping, find_mapping, read_mapping
from rga.records.read import Table, read_table
from rga.records.record import Record

#: deviations of the noise of a context, by which a value lies outside its range by chance
CHANCE = 4.0


def load_record(
    path: str | Path, model: Model, mapping: str | Path | RecordMapping | None = None
) -> Record:
    """Read a measured record into the channels, units and contexts of a model.

    Args:
        path: CSV or Parquet file, or a logger's text file.
        model: names the sensors and contexts and states their units.
        mapping: the mapping, or its file; left out, `import.toml` beside the record, else beside
            the model, else none: the columns are named and measured as the model says.

    Raises:
        InputError: the file, or what it holds, cannot be used as it stands.
    """
    path = Path(path)
    if not isinstance(mapping, RecordMapping):
        found = mapping or find_mapping(path, model.path)
        mapping = read_mapping(found) if found else RecordMapping()
    table = read_table(path, mapping.delimiter)
    clock = read_clock(table, mapping.time)
    columns = _channel_columns(table, mapping, model)
    sensors = tuple(name for name in model.sensors if name in columns)
    if not sensors:
        raise InputError("no sensor of the model is in the record", str(path), "check the mapping")
    readings = np.column_stack([_values(table, columns[name], name, model) for name in sensors])
    contexts = {
        name: _values(table, columns[name], name, model)
        for name in model.context
        if name in columns
    }
    zero = _zero_interval(clock.seconds, readings, mapping, str(path))
    if zero is not None:
        readings = readings - _rest(clock.seconds, readings, zero, sensors, str(path))
    return Record(
        time=clock.seconds,
        start=clock.start,
        time_format=clock.time_format,
        sensors=sensors,
        readings=readings,
        contexts=contexts,
        unused=_unused(table, mapping, model),
        zero=zero,
        warnings=[text for name in contexts for text in _doubts(name, contexts[name], model)],
        sha256=table.sha256,
    )


def _channel_columns(
    table: Table, mapping: RecordMapping, model: Model
) -> dict[str, tuple[str, Channel]]:
    """Sensor or context variable -> its column, and how to read it."""
    known = {**model.sensors, **model.context}
    where = str(table.path)
    for name, channel in mapping.channels.items():
        if name not in known:
            raise InputError(
                f"the mapping names the channel {name!r}, which the model does not have",
                where,
                "name a sensor or context variable of the model",
            )
        if channel.column is not None and channel.column not in table.frame.columns:
            raise InputError(
                f"the mapping names the column {channel.column!r}, which the file does not have",
                where,
                "correct the column's name",
            )
    named = {channel.column: name for name, channel in mapping.channels.items() if channel.column}
    columns: dict[str, tuple[str, Channel]] = {}
    unknown = []
    for column in table.frame.columns:
        if column in mapping.time.columns:
            continue
        stated, unit = mapping.channel_of(column)
        name = named.get(column, stated)
        if name in mapping.unused or column in mapping.unused:
            continue
        if name not in known:
            unknown.append(column)
        elif name in columns:
            raise InputError(
                f"the columns {columns[name][0]!r} and {column!r} both give {name!r}",
                where,
                "list one of them under [unused] in import.toml",
            )
        else:
            channel = mapping.channels.get(name, Channel())
            columns[name] = (column, channel.model_copy(update={"unit": channel.unit or unit}))
    if unknown:
        raise InputError(
            "the model has no sensor or context variable for " + _quoted(unknown),
            where,
            "list what is not used under [unused] in import.toml, with the reason",
        )
    missing = [name for name in model.sensors if name not in columns and name not in mapping.unused]
    if missing:
        raise InputError(
            "there is no column for the sensors " + _quoted(missing),
            where,
            "add the columns, or list the sensors under [unused] in import.toml, with the reason",
        )
    return columns


def _values(table: Table, place: tuple[str, Channel], name: str, model: Model) -> FloatArray:
    """Values of a channel in the unit of the model, float[n]."""
    column, channel = place
    values = table.numbers(column)
    if np.isnan(values).all():
        raise InputError(
            f"column {column!r} holds no value",
            str(table.path),
            "list the channel under [unused] in import.toml, with the reason",
        )
    return values * (channel.sign * _scale(channel.unit, name, model))


def _scale(unit: str | None, name: str, model: Model) -> float:
    """Units of the model per unit of the file."""
    where = f"mapping of {name!r}"
    if name in model.sensors:
        sensor = model.sensors[name]
        if unit is None or unit == sensor.unit:
            return 1.0
        return per_si(sensor.kind, sensor.unit, where) / per_si(sensor.kind, unit, where)
    wanted = model.context[name].unit
    if unit is None or unit == wanted:
        return 1.0
    for units in UNITS.values():
        if unit in units and wanted in units:
            return units[wanted] / units[unit]
    raise InputError(
        f"the unit {unit!r} is not that of the context variable", where, f"convert it to {wanted}"
    )


def _zero_interval(
    time: FloatArray, readings: FloatArray, mapping: RecordMapping, where: str
) -> tuple[float, float] | None:
    if mapping.zero == "lead-in":
        return find_lead_in(time, readings, where)
    return mapping.zero


def _rest(
    time: FloatArray,
    readings: FloatArray,
    zero: tuple[float, float],
    sensors: tuple[str, ...],
    where: str,
) -> FloatArray:
    """Mean of every channel over the zero interval, float[channels]."""
    within = readings[(time >= zero[0]) & (time <= zero[1])]
    empty = [name for name, values in zip(sensors, within.T, strict=True) if np.isnan(values).all()]
    if empty:
        raise InputError(
            f"no value between {zero[0]:g} s and {zero[1]:g} s to zero {_quoted(empty)} on",
            where,
            "give another zero = [from, to] in import.toml",
        )
    return np.asarray(np.nanmean(within, axis=0))


def _unused(table: Table, mapping: RecordMapping, model: Model) -> dict[str, str]:
    present = {
        name for column in table.frame.columns for name in (column, mapping.channel_of(column)[0])
    }
    return {
        name: reason
        for name, reason in mapping.unused.items()
        if name in present or name in model.sensors
    }


def _doubts(name: str, values: FloatArray, model: Model) -> list[str]:
    """What the reader should know of a measured context, in words."""
    low, high = model.context[name].range
    unit = model.context[name].unit
    # A load that is not there reads a little below nothing.
    margin = CHANCE * (model.context[name].noise or 0.0)
    outside = int(((values < low - margin) | (values > high + margin)).sum())
    missing = int(np.isnan(values).sum())
    warnings = []
    if outside:
        warnings.append(
            f"{name} lies outside its range {low:g}..{high:g} {unit} in {outside} of {len(values)} "
            f"rows (it runs from {np.nanmin(values):g} to {np.nanmax(values):g})"
        )
    if missing:
        warnings.append(f"{name} is missing in {missing} of {len(values)} rows")
    return warnings


def _quoted(names: list[str]) -> str:
    shown = ", ".join(repr(name) for name in names[:8])
    return shown if len(names) <= 8 else f"{shown} and {len(names) - 8} more"
