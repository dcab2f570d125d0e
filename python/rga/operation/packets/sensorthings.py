"""Observations and data arrays of OGC SensorThings.

Source: OGC 15-078r6, SensorThings API, sections 8.2.6 and 13 (data arrays).
"""

import re
from collections.abc import Iterator, Mapping
from datetime import tzinfo
from typing import Any

import msgspec

from rga.errors import InputError
from rga.operation.packets.moments import moment_of_stamp
from rga.operation.packets.packet import SensorPacket
from rga.operation.packets.readings import SensorReading, check_size, packets_of

_Entry = dict[str, Any]
_DECODER = msgspec.json.Decoder(_Entry | list[_Entry])
_LINK = "Datastream@iot.navigationLink"
_STREAM = re.compile(r"Datastreams\(([^()]{1,100})\)")


def read_sensorthings(
    payload: bytes, where: str, arrived: int, zone: tzinfo | None
) -> list[SensorPacket]:
    """The packets of observations; results are of the time of the phenomenon.

    A channel has the name of its data stream, or is called "Datastreams(id)".

    Args:
        payload: an observation, several, or data arrays, as JSON.
        where: it came from: a topic may name the data stream.
        arrived: of observations without a time, microseconds since 1970 (UTC).
        zone: of time stamps that have none.

    Raises:
        InputError: it is none of these, or says what no logger can.

    >>> one = b'{"result":1.5,"phenomenonTime":"2026-11-23T00:00:00Z","Datastream":{"@iot.id":7}}'
    >>> read_sensorthings(one, "a test", 0, None)[0].channels
    ('Datastreams(7)',)
    """
    check_size(payload, where)
    try:
        content = _DECODER.decode(payload)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError, OverflowError) as error:
        raise InputError(
            f"these are no observations: {str(error)[:200]}", where, "write JSON of SensorThings"
        ) from None
    entries = content if isinstance(content, list) else content.get("value", [content])
    if not isinstance(entries, list) or not all(isinstance(one, dict) for one in entries):
        raise InputError("these are no observations", where, "write JSON of SensorThings")
    units: dict[str, str] = {}
    points, timed = [], True
    for entry in entries:
        name, unit = _stream_of(entry, where)
        units.setdefault(name, unit)
        for time, result in _rows_of(entry, where):
            moment = arrived
            if isinstance(time, str):
                # Of an interval, the result is there at its end.
                moment = moment_of_stamp(time.rsplit("/", 1)[-1], zone, where)
            elif time is None:
                timed = False
            else:
                raise InputError("a phenomenonTime is no text", where, "write it in ISO 8601")
            points.append(SensorReading(name, moment, _number(result, where)))
    return packets_of(points, units, where, timed=timed)


def _stream_of(entry: _Entry, where: str) -> tuple[str, str]:
    """Name and unit of the data stream that an entry is of."""
    stream = entry.get("Datastream")
    stream = stream if isinstance(stream, dict) else {}
    unit = stream.get("unitOfMeasurement")
    symbol = unit.get("symbol") if isinstance(unit, dict) else None
    symbol = symbol if isinstance(symbol, str) else ""
    if isinstance(name := stream.get("name"), str) and name:
        return name, symbol
    if isinstance(known := stream.get("@iot.id"), (int, str)):
        return f"Datastreams({known})", symbol
    links = (entry.get(_LINK), stream.get("@iot.selfLink"), where)
    found = next((one for link in links if (one := _STREAM.search(str(link)))), None)
    if found is None:
        raise InputError(
            "an observation has no data stream", where, "give Datastream, or send to its topic"
        )
    return f"Datastreams({found[1]})".replace("'", ""), symbol


def _rows_of(entry: Mapping[str, Any], where: str) -> Iterator[tuple[Any, Any]]:
    """Time and result of each row of a data array, or of an observation."""
    if "dataArray" not in entry:
        if "result" not in entry:
            raise InputError("an observation has no result", where, "write JSON of SensorThings")
        yield entry.get("phenomenonTime"), entry["result"]
        return
    components, rows = entry.get("components"), entry["dataArray"]
    if not isinstance(components, list) or not isinstance(rows, list):
        raise InputError(
            "a data array has no components", where, "give what each of its places means"
        )
    if "result" not in components:
        raise InputError("a data array has no result", where, "give phenomenonTime and result")
    result = components.index("result")
    time = components.index("phenomenonTime") if "phenomenonTime" in components else None
    for row in rows:
        if not isinstance(row, list) or len(row) != len(components):
            raise InputError(
                f"a row of the data array has not {len(components)} places as its components",
                where,
                "write a place for each",
            )
        yield (None if time is None else row[time]), row[result]


def _number(value: Any, where: str) -> float:
    if value is None:
        return float("nan")
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    raise InputError(f"the result {str(value)[:40]!r} is no number", where, "leave it out")
