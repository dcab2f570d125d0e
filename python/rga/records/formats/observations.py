"""JSON of sensor networks: OGC SensorThings observations, and SenML packs.

Sources: OGC 15-078r6, SensorThings API, sections 8.2.6 and 13 (data arrays); RFC 8428, Sensor
Measurement Lists, section 4 (base fields and resolution).
"""

import json
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

import polars as pl

from rga.errors import InputError
from rga.records.formats.encoding import Text
from rga.records.formats.points import table_of_points
from rga.records.record import LARGEST
from rga.records.table import Table

#: version of SenML that is understood, and the time below which one is relative to now [s]
_VERSION, _RELATIVE = 10, 2**28
#: seconds from 1970 to the end of the year 9999
_LAST = 253_402_300_799
_LINK, _COUNT = "Datastream@iot.navigationLink", "dataArray@iot.count"
_SENML = {
    "bn", "bt", "bu", "bv", "bs", "bver", "n", "u", "v", "vs", "vb", "vd", "s", "t", "ut",
}  # fmt: skip


def is_json(text: Text) -> bool:
    """Whether a text begins as JSON does."""
    return text.data[:200].lstrip()[:1] in (b"{", b"[") and b'"' in text.data[:2000]


def read_observations(text: Text) -> Table:
    """Read SensorThings observations or a SenML pack.

    Raises:
        InputError: it is no JSON, or neither of both, or one that says too little.
    """
    try:
        content = json.loads(text.data)
    except (ValueError, RecursionError) as error:
        line = f", line {error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        said = error.msg if isinstance(error, json.JSONDecodeError) else "it is nested too deep"
        raise InputError(
            f"this is no JSON: {said}", f"{text.path}{line}", "copy the file again in full"
        ) from None
    entries = content.get("value", [content]) if isinstance(content, dict) else content
    if not isinstance(entries, list) or not all(isinstance(one, dict) for one in entries):
        entries = []
    if entries and isinstance(content, list) and all(_SENML & one.keys() for one in entries):
        return _senml(entries, text)
    if entries and all(one.keys() & {"dataArray", "phenomenonTime"} for one in entries):
        return _sensorthings(entries, text)
    raise InputError(
        "the JSON is neither SenML nor SensorThings observations",
        str(text.path),
        "give one of these, or CSV",
    )


def _sensorthings(entries: Sequence[Mapping[str, Any]], text: Text) -> Table:
    """Results at the times of the phenomenon, not at those at which they were computed."""
    points: list[tuple[datetime, str, float | None]] = []
    units: dict[str, str] = {}
    for number, entry in enumerate(entries, 1):
        where = f"{text.path}, entry {number}"
        stream = entry.get("Datastream")
        stream = stream if isinstance(stream, dict) else {}
        link = entry.get(_LINK, stream.get("@iot.selfLink", ""))
        known = f"Datastreams({stream['@iot.id']})" if "@iot.id" in stream else "result"
        name = str(stream.get("name") or str(link).rsplit("/", 1)[-1] or known)
        if name == "Datastream":
            name = "result"
        unit = stream.get("unitOfMeasurement", {}).get("symbol") if stream else None
        if unit:
            units[name] = str(unit)
        rows = _rows_of(entry, where) if "dataArray" in entry else [entry]
        points += [
            (_moment(row.get("phenomenonTime"), where), name, _result(row.get("result"), where))
            for row in rows
        ]
    notes = [*text.notes, "times are those of the phenomenon"]
    return _table(points, "SensorThings observations", units, {}, notes, text)


def _rows_of(entry: Mapping[str, Any], where: str) -> list[Mapping[str, Any]]:
    components, data = entry.get("components"), entry["dataArray"]
    if not isinstance(components, list) or not isinstance(data, list):
        raise InputError(
            "the data array has no components", where, "give what each of its places means"
        )
    if missing := {"phenomenonTime", "result"} - set(map(str, components)):
        raise InputError(
            f"the data array has no {sorted(missing)[0]}", where, "ask for it by $select"
        )
    if any(not isinstance(row, list) or len(row) != len(components) for row in data):
        raise InputError(
            f"a row of the data array has not {len(components)} places as its components",
            where,
            "copy the file again in full",
        )
    return [dict(zip(components, row, strict=True)) for row in data]


def _moment(stamp: Any, where: str) -> datetime:
    # Of an interval, the result is there at its end.
    last = str(stamp).rsplit("/", 1)[-1]
    try:
        moment = datetime.fromisoformat(last)
    except ValueError:
        raise InputError(
            f"the time {stamp!r} cannot be read", where, "give phenomenonTime in ISO 8601"
        ) from None
    return moment.astimezone(UTC) if moment.tzinfo else moment.replace(tzinfo=UTC)


def _result(value: Any, where: str) -> float | None:
    if value is None:
        return None
    try:
        if not isinstance(value, bool):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise InputError(f"the result {str(value)[:40]!r} is no number", where, "leave it out")


def _senml(entries: Sequence[Mapping[str, Any]], text: Text) -> Table:
    """Records with what the base fields before them add (RFC 8428, section 4.6)."""
    base: dict[str, Any] = {}
    points: list[tuple[float, str, float | None]] = []
    units: dict[str, str] = {}
    sums = 0
    for number, entry in enumerate(entries, 1):
        where = f"{text.path}, record {number}"
        base.update({key: value for key, value in entry.items() if key in _SENML and key[0] == "b"})
        _understood(entry, base, where)
        name = f"{base.get('bn', '')}{entry.get('n', '')}"
        if "v" not in entry:
            sums += "s" in entry
            continue
        if not name:
            raise InputError("the record has no name", where, "give n or bn")
        unit = entry.get("u", base.get("bu"))
        if units.setdefault(name, str(unit or "")) != str(unit or ""):
            raise InputError(
                f"{name!r} is in {units[name]!r} before, and in {unit!r} here", where, "use one"
            )
        time = _number(base.get("bt", 0), where) + _number(entry.get("t", 0), where)
        value = _number(base.get("bv", 0), where) + _number(entry["v"], where)
        points.append((round(time, 6), name, value))
    last = {name: name.replace("/", ":").rsplit(":", 1)[-1] for name in units}
    names = {name: short for name, short in last.items() if list(last.values()).count(short) == 1}
    notes = list(text.notes) + (["sums (s) are left out"] if sums else [])
    absolute = [time >= _RELATIVE for time, *_ in points]
    if any(absolute) and not all(absolute):
        raise InputError(
            "some times are since 1970 and some relative to now", str(text.path), "write all alike"
        )
    units = {name: unit for name, unit in units.items() if unit}
    if not any(absolute):
        notes.append("times are relative to when the pack was sent")
        return _table(points, "SenML", units, names, notes, text)
    if max(time for time, *_ in points) > _LAST:
        raise InputError("a time lies beyond the year 9999", str(text.path), "write seconds")
    moments = [
        (datetime.fromtimestamp(int(time), UTC).replace(microsecond=_micro(time)), *rest)
        for time, *rest in points
    ]
    return _table(moments, "SenML", units, names, notes, text)


def _micro(time: float) -> int:
    return min(round((time - int(time)) * 1e6), 999_999)


def _understood(entry: Mapping[str, Any], base: Mapping[str, Any], where: str) -> None:
    if _number(base.get("bver", _VERSION), where) > _VERSION:
        raise InputError(
            f"SenML of version {base['bver']} is not known", where, f"write version {_VERSION}"
        )
    if unknown := [key for key in entry if key.endswith("_")]:
        raise InputError(
            f"the field {unknown[0]!r} must be understood, and is not", where, "leave it out"
        )


def _number(value: Any, where: str) -> float:
    if isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < LARGEST:
        return float(value)
    raise InputError(f"{str(value)[:40]!r} is no number", where, "write a number")


def _table(
    points: Sequence[tuple[Any, ...]],
    format_name: str,
    units: Mapping[str, str],
    names: Mapping[str, str],
    notes: Sequence[str],
    text: Text,
) -> Table:
    if not points:
        raise InputError("there is no reading in the file", str(text.path), "give at least one")
    frame = pl.DataFrame(points, schema=["time", "channel", "value"], orient="row",
                         infer_schema_length=None)  # fmt: skip
    frame = frame.with_columns(pl.col("value").cast(pl.Float64))
    return table_of_points(text.path, frame, format_name, units, names, notes)
