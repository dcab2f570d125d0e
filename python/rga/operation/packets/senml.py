"""SenML in JSON.

Source: RFC 8428, Sensor Measurement Lists, section 4 (base fields and resolution).
"""

from collections.abc import Iterator
from typing import Any

import msgspec

from rga.errors import InputError
from rga.operation.packets.moments import checked
from rga.operation.packets.packet import MICROSECONDS, SensorPacket
from rga.operation.packets.readings import SensorReading, check_size, packets_of
from rga.records.record import LARGEST

#: version that is understood, and the time below which one is relative to now [s]
_VERSION, _RELATIVE = 10, 2**28
_Record = dict[str, float | str | bool]
# Nothing in SenML is nested, so nothing deep is ever read.
_DECODER = msgspec.json.Decoder(list[_Record])


def read_senml(payload: bytes, where: str, arrived: int) -> list[SensorPacket]:
    """The packets of a pack: its records with what the base fields before them add.

    Texts, data and sums are left out.

    Args:
        payload: JSON.
        where: it came from, for an error.
        arrived: to which relative times refer, microseconds since 1970 (UTC).

    Raises:
        InputError: it is no pack, or one that no logger can mean.

    >>> pack = b'[{"bn":"east/","bt":1795392000,"n":"D1","v":1.5},{"n":"D1","t":1,"v":2.5}]'
    >>> [(one.channels, one.values.tolist()) for one in read_senml(pack, "a test", 0)]
    [(('east/D1',), [[1.5], [2.5]])]
    """
    check_size(payload, where)
    try:
        records = _DECODER.decode(payload)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError, OverflowError) as error:
        raise InputError(
            f"this is no SenML: {str(error)[:200]}", where, "write it as RFC 8428 says"
        ) from None
    units: dict[str, str] = {}
    points, timed = [], True
    for name, unit, time, value in _resolved(records, where):
        moment = round(time * MICROSECONDS)
        if time < _RELATIVE:
            moment, timed = arrived + moment, False
        points.append(SensorReading(name, checked(moment, where), value))
        if units.setdefault(name, unit) != unit:
            raise InputError(
                f"{name!r} is in {units[name]!r} and in {unit!r}", where, "use one unit"
            )
    return packets_of(points, units, where, timed=timed)


def _resolved(records: list[_Record], where: str) -> Iterator[tuple[str, str, float, float]]:
    """Name, unit, time [s] and value of records that hold a number."""
    base: _Record = {}
    name, unit, time, value = "", "", 0.0, 0.0
    for record in records:
        if changed := record.keys() & _BASE:
            base.update({key: record[key] for key in changed})
            name, unit = (_text(base.get(key, ""), where) for key in ("bn", "bu"))
            time, value = (_number(base.get(key, 0), where) for key in ("bt", "bv"))
            if _number(base.get("bver", _VERSION), where) > _VERSION:
                raise InputError(
                    f"SenML of version {base['bver']} is not known",
                    where,
                    f"write version {_VERSION}",
                )
        if unknown := next((key for key in record if key.endswith("_")), None):
            raise InputError(
                f"the field {unknown[:20]!r} must be understood, and is not", where, "leave it out"
            )
        if "v" in record:
            yield (
                name + _text(record.get("n", ""), where),
                _text(record.get("u", unit), where),
                time + _number(record.get("t", 0), where),
                value + _number(record["v"], where),
            )


_BASE = {"bn", "bt", "bu", "bv", "bver"}


def _number(value: Any, where: str) -> float:
    if isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < LARGEST:
        return float(value)
    raise InputError(f"{str(value)[:40]!r} is no number", where, "write a number")


def _text(value: Any, where: str) -> str:
    if isinstance(value, str):
        return value
    raise InputError(f"{str(value)[:40]!r} is no text", where, "write names and units as text")
