"""Which column is which sensor or context variable, and its values in the unit of the model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.quantities import counted
from rga.records.mapped_channels import check_channels
from rga.records.mapping import Channel, FileMapping
from rga.records.numbers import missing_words
from rga.records.table import Table
from rga.records.units import contradict, conversion, name_and_unit, states_none


@dataclass(frozen=True)
class ColumnSource:
    """Where a sensor or context variable stands in a table.

    Attributes:
        column: that has it.
        channel: how it is read.
        unit: in which it is read; None: that is not said.
        outweighed: the unit that the file states where the mapping states another; None: none.
    """

    column: str
    channel: Channel
    unit: str | None
    outweighed: str | None = None


def sources_of(
    table: Table, mapping: FileMapping, model: Model, time_columns: Sequence[str]
) -> dict[str, ColumnSource]:
    """Sensor or context variable -> its column, and how to read it.

    Raises:
        InputError: the mapping names what is not there, a column has no meaning, or two have the
            same.

    Whether a unit can be that of its channel is for `unit_fault` to say.
    """
    known = {**model.sensors, **model.context}
    where = str(table.path)
    check_channels(mapping, model, where)
    named = _named(table, mapping)
    sources: dict[str, ColumnSource] = {}
    unknown = []
    left_out = mapping.left_out.keys()
    for column in table.frame.columns:
        if column in time_columns and column not in named:
            continue
        name, unit = _name_and_unit(table, mapping, column, known)
        name = named.get(column, name)
        if {name, column, table.names.get(column, column)} & left_out:
            continue
        if name not in known:
            if column not in table.bookkeeping:
                unknown.append(column)
        elif name in sources:
            raise InputError(
                f"the columns {sources[name].column!r} and {column!r} both give {name!r}",
                where,
                "list one of them under [unused] in import.toml",
            )
        else:
            channel = mapping.channels.get(name, Channel())
            stated = channel.unit
            outweighed = unit if stated and unit and contradict(stated, unit) else None
            sources[name] = ColumnSource(column, channel, stated or unit, outweighed)
    if unknown and mapping.unknown == "refused":
        raise InputError(
            "the model has no sensor or context variable for " + quoted(unknown, len(unknown)),
            where,
            "list what is not used under [unused] in import.toml, with the reason, or name the "
            "column of a channel: [channels] NAME = { column = ... }; "
            "`rga import-record FILES --model MODEL` writes a first import.toml",
        )
    return sources


def unit_fault(table: Table, name: str, source: ColumnSource, model: Model) -> InputError | None:
    """Why the unit of a column cannot be that of its channel; None: it can.

    Args:
        table: that has the column.
        name: of the sensor or context variable.
        source: where it stands in the table.
        model: of the sensor or context variable.
    """
    column = source.column
    where = f"{table.path}, column {column!r}"
    named, stated = name_and_unit(column)[1], table.units.get(column)
    contradicts = named is not None and stated is not None and contradict(named, stated)
    if source.channel.unit is None and contradicts:
        sensor = model.sensors.get(name)
        unit = sensor.unit if sensor else model.context[name].unit
        return InputError(
            f"the name of {name!r} says {named!r}, the line of units says {stated!r}",
            where,
            f'state it: {name} = {{ unit = "{unit}" }} under [channels] in import.toml',
        )
    if source.unit is not None:
        try:
            conversion(source.unit, name, model, where)
        except InputError as error:
            return error
    return None


def values_of(
    table: Table, mapping: FileMapping, name: str, source: ColumnSource, model: Model
) -> FloatArray:
    """Values of a channel in the unit of the model, float[n], NaN where one is missing.

    Raises:
        InputError: a cell holds no number, there is none at all, or the unit is of something else.
    """
    if fault := unit_fault(table, name, source, model):
        raise fault
    where = f"{table.path}, column {source.column!r}"
    values = table.numbers(source.column, (*mapping.missing, *source.channel.missing))
    if mapping.empty == "refused" and np.isnan(values).all():
        raise InputError(
            f"column {source.column!r} holds no value",
            str(table.path),
            "list the channel under [unused] in import.toml, with the reason, or state "
            'empty = "missing"',
        )
    if source.unit is None:
        return values * source.channel.sign
    factor, offset = conversion(source.unit, name, model, where)
    return values * (source.channel.sign * factor) + offset


def told_of(
    table: Table, mapping: FileMapping, sources: dict[str, ColumnSource], model: Model
) -> list[str]:
    """What was assumed of units, and what stands for missing values, in words."""
    told = []
    sensors = {name: sensor.unit for name, sensor in model.sensors.items()}
    units = sensors | {name: context.unit for name, context in model.context.items()}
    silent = [name for name, source in sources.items() if source.unit is None]
    # A file of rga's own states no unit at all: it is in those of the model by its contract.
    if silent and (table.units or table.format not in ("plain text", "Parquet", "data frame")):
        shown = ", ".join(f"{name} ({units[name]})" for name in silent[:8])
        more = f" and {len(silent) - 8} more" if len(silent) > 8 else ""
        told.append(f"no unit is stated for {shown}{more}: the model's is taken")
    changed = [
        f"{name} from {source.unit} to {units[name]}"
        for name, source in sources.items()
        if source.unit and conversion(source.unit, name, model, "") != (1.0, 0.0)
    ]
    if changed:
        told.append("units are converted: " + "; ".join(changed))
    words: dict[str, list[str]] = {}
    for name, source in sources.items():
        stated = (*table.missing, *mapping.missing, *source.channel.missing)
        series = table.frame[source.column]
        for word, rows in missing_words(series, table.notation, stated).items():
            words.setdefault(word, []).append(f"{name} ({counted(rows, 'row')})")
    for word, places in words.items():
        more = f" and {len(places) - 5} more channels" if len(places) > 5 else ""
        told.append(f"{word!r} stands for a missing value: {', '.join(places[:5])}{more}")
    return told


def doubts_of(sources: Mapping[str, ColumnSource]) -> dict[str, str]:
    """By column, what the reader of a table should know of its unit.

    >>> doubts_of({"D1": ColumnSource("LVDT 5", Channel(unit="cm"), "cm", "mm")})
    {'LVDT 5': 'import.toml says cm, and what comes says mm: it is read in cm'}
    """
    return {
        one.column: f"import.toml says {one.unit}, and what comes says {one.outweighed}: "
        f"it is read in {one.unit}"
        for one in sources.values()
        if one.outweighed
    }


def unused_in(table: Table, mapping: FileMapping, model: Model) -> dict[str, str]:
    """Channels of a table that are left out, and sensors that it has not, with the reason."""
    present = {
        name
        for column in table.frame.columns
        for name in (column, mapping.channel_of(column)[0], table.names.get(column, column))
    }
    return {
        name: reason
        for name, reason in mapping.left_out.items()
        if name in present or name in model.sensors
    }


def quoted(names: Sequence[str], most: int = 8) -> str:
    """Names in quotes, the first of many.

    >>> quoted(["a", "b", "c"], 2)
    "'a', 'b' and 1 more"
    """
    shown = ", ".join(repr(name) for name in names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"


def _named(table: Table, mapping: FileMapping) -> dict[str, str]:
    """Channel by the column that the mapping names for it."""
    where = str(table.path)
    named: dict[str, str] = {}
    for name, channel in mapping.channels.items():
        if channel.column is None:
            continue
        column = channel.column
        if column not in table.frame.columns:
            alike = [one for one, bare in table.names.items() if bare == column]
            if len(alike) != 1:
                raise InputError(
                    f"the mapping names the column {column!r}, which the file does not have",
                    where,
                    f"correct the column's name: it has {quoted(table.frame.columns, 20)}",
                )
            column = alike[0]
        if column in named:
            raise InputError(
                f"the channels {named[column]!r} and {name!r} both name the column {column!r}",
                where,
                "name another column for one of them",
            )
        named[column] = name
    return named


def _name_and_unit(
    table: Table, mapping: FileMapping, column: str, known: Mapping[str, object]
) -> tuple[str, str | None]:
    """Channel and unit that a column states: by the header pattern, or by itself."""
    if mapping.header is not None:
        name, unit = mapping.channel_of(column)
        if unit is not None and not states_none(unit):
            return name, unit
        return name, table.units.get(column)
    if column in known and column in table.names:  # brackets that are part of the name
        unit = table.units.get(column)
        return column, None if unit == name_and_unit(column)[1] else unit
    bare = table.names.get(column, column)
    return (bare if bare in known else column), table.units.get(column)
