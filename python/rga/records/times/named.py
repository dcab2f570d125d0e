"""Columns that hold the time, known by their names and by what stands in them."""

import re
from collections.abc import Mapping

import polars as pl

from rga.records.table import StatedTime
from rga.records.units import name_and_unit, unit_of

#: names of a column of elapsed time, or of time stamps, in lower case
_TIMES = {
    "time", "zeit", "t", "temps", "tiempo", "tempo", "tijd", "laufzeit", "elapsed", "seconds",
    "elapsed time", "running time", "messzeit", "sekunden", "x_value", "relative time",
}  # fmt: skip
_STAMPS = {
    "timestamp", "time stamp", "time_stamp", "datetime", "date time", "date/time", "date_time",
    "datum/zeit", "datum zeit", "datum/uhrzeit", "datum uhrzeit", "zeitstempel", "date and time",
    "date & time", "date-time", "ts", "utc", "time utc", "utc time", "local time", "localtime",
    "absolute time", "horodatage", "fecha hora", "phenomenontime",
}  # fmt: skip
_DATES = {"date", "datum", "fecha", "data", "day", "tag"}
_CLOCKS = {"time", "zeit", "uhrzeit", "heure", "hora", "ora", "clock", "tijd"}
_DATE = r"\d{1,4}[-./]\d{1,2}[-./]\d{1,4}|\d{1,2}[-. ]?[A-Za-z]{3}[-. ]?\d{2,4}"
_ZONE = re.compile(r"(?P<name>[^,(]+?),? \(?(?P<zone>(UTC|GMT)[+-]\d{1,2}:\d{2})\)?")
_CLOCK = r"\d{1,2}:\d{2}.*"


def time_of(frame: pl.DataFrame, units: Mapping[str, str]) -> StatedTime | None:
    """The time of a table whose format does not say which column it is.

    Args:
        frame: columns as text.
        units: by column.

    Returns:
        None where no column can be nothing but the time, or where it is named `time`.

    >>> frame = pl.DataFrame({"F": ["1"], "Zeit [s]": ["0,5"]})
    >>> time_of(frame, {"Zeit [s]": "s"})
    StatedTime(columns=('Zeit [s]',), format=None, start=None, step=None, unit=1.0, zone=None)
    """
    first = {column: _first(frame[column]) for column in frame.columns}
    plain = {column: " ".join(name_and_unit(column)[0].lower().split()) for column in first}
    # HOBO loggers write the zone into the name: "Date Time, GMT+02:00".
    zones = {column: _ZONE.fullmatch(column) for column in first}
    plain |= {column: found["name"].lower() for column, found in zones.items() if found}
    date = next((c for c in first if plain[c] in _DATES and _is(_DATE, first[c])), None)
    clock = next((c for c in first if plain[c] in _CLOCKS and _is(_CLOCK, first[c])), None)
    if date is not None and clock is not None:
        return StatedTime((date, clock))
    if "time" in first:
        return None
    for column, cell in first.items():
        if plain[column] in _STAMPS | _TIMES | _DATES and _is(f"({_DATE})[T ]+{_CLOCK}", cell):
            zone = zones[column]
            return StatedTime((column,), zone=zone["zone"] if zone else None)
    for column in first:
        unit = unit_of(units[column]) if column in units else None
        named = plain[column] in _TIMES or re.match(r"(time|zeit) ", plain[column])
        if named and unit is not None and unit.dimension == "time":
            return StatedTime((column,), unit=unit.size)
    written = (c for c in first if plain[c] == "time" and c not in units)
    return next((StatedTime((column,)) for column in written), None)


def _first(series: pl.Series) -> str:
    held = series.drop_nulls()
    return str(held[0]) if len(held) else ""


def _is(pattern: str, cell: str) -> bool:
    return re.fullmatch(pattern, cell) is not None
