"""Loading a measured record against a model."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model, as_model
from rga.records.beside import side_by_side
from rga.records.channels import quoted
from rga.records.frames import RecordSource, is_frame, table_of_frame
from rga.records.lead_in import find_lead_in
from rga.records.logger_data import LoggerData, in_time, measured
from rga.records.mapping import FileMapping, RecordMapping, read_mapping
from rga.records.read import read_table
from rga.records.record import Record
from rga.records.sources import files_in, find_sources, named_files

#: deviations of the noise of a context, by which a value lies outside its range by chance
CHANCE = 4.0
#: rows in which a sensor that works does not show the same number throughout
STILL = 50


def load_record(
    source: RecordSource,
    model: Model | str | Path,
    mapping: str | Path | RecordMapping | None = None,
) -> Record:
    """Read a measured record into the channels, units and contexts of a model.

    Args:
        source: a file of any format that is known; several that follow each other in time; a folder
            whose `import.toml` names its files; or a data frame of polars or pandas.
        model: names the sensors and contexts and states their units; or its file.
        mapping: the mapping, or its file; left out, `import.toml` beside the record, else beside
            the model, else none: the columns are named and measured as the model says. One that was
            not named, and says that the time stands elsewhere, is not of what `Record.write` wrote.

    Raises:
        InputError: a file, or what it holds, cannot be used as it stands, or this is no record.

    Example: `load_record(["january.csv", "february.csv"], model)` reads two months as one record.
    """
    model = as_model(model)
    chosen: RecordMapping
    if is_frame(source):
        if mapping is None or isinstance(mapping, RecordMapping):
            chosen = mapping or RecordMapping()
        else:
            chosen = read_mapping(mapping)
        main = measured(table_of_frame(source), chosen, model)
    else:
        names = {*model.sensors, *model.context}
        paths, chosen = find_sources(named_files(source), model.path, mapping, names)
        main = _logger(paths, chosen, model)
    noises = {name for name, one in model.sensors.items() if one.noise is not None}
    noises |= {name for name, one in model.context.items() if one.noise is not None}
    for other in chosen.beside:
        paths = files_in(chosen.folder, other.files)
        main = side_by_side(main, _logger(paths, other, model), other, noises)
    return _record(main, chosen, model)


def _logger(paths: Sequence[Path], mapping: FileMapping, model: Model) -> LoggerData:
    """Files of one logger."""
    named = (channel.column for channel in mapping.channels.values())
    known = {*model.sensors, *model.context, *mapping.time.columns, *mapping.unused}
    known |= {column for column in named if column}
    return in_time([measured(read_table(path, mapping, known), mapping, model) for path in paths])


def _record(found: LoggerData, mapping: RecordMapping, model: Model) -> Record:
    where = found.where
    left_out = {*mapping.left_out}.union(*(other.left_out for other in mapping.beside))
    sensors = tuple(name for name in model.sensors if name in found.values)
    missing = [name for name in model.sensors if name not in sensors and name not in left_out]
    if missing:
        raise InputError(
            "there is no column for the sensors " + quoted(missing),
            where,
            "add the columns, or list the sensors under [unused] in import.toml, with the reason",
        )
    if not sensors:
        raise InputError("no sensor of the model is in the record", where, "check the mapping")
    readings = np.column_stack([found.values[name] for name in sensors])
    contexts = {name: found.values[name] for name in model.context if name in found.values}
    time = found.clock.seconds
    zero = _zero_interval(time, readings, mapping, where)
    if zero is not None:
        readings = readings - _rest(time, readings, zero, sensors, where)
    return Record(
        time=time,
        start=found.clock.start,
        time_format=found.clock.time_format,
        sensors=sensors,
        readings=readings,
        contexts=contexts,
        unused={name: why for name, why in found.unused.items() if name not in found.values},
        zero=zero,
        warnings=[
            *found.warnings,
            *_still(sensors, readings),
            *(text for name in contexts for text in _doubts(name, contexts[name], model)),
        ],
        notes=list(found.notes),
        sha256=found.sha256,
    )


def _still(sensors: Sequence[str], readings: FloatArray) -> list[str]:
    """Warnings of sensors that show one number throughout."""
    warnings = []
    for name, values in zip(sensors, readings.T, strict=True):
        held = values[np.isfinite(values)]
        if len(held) >= STILL and (held == held[0]).all():
            warnings.append(f"{name} reads {held[0]:g} in all {len(held)} rows: it never moves")
    return warnings


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
            f"no value between {zero[0]:g} s and {zero[1]:g} s to zero {quoted(empty)} on",
            where,
            "give another zero = [from, to] in import.toml",
        )
    return np.asarray(np.nanmean(within, axis=0))


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
