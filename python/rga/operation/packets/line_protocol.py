"""Line protocol of InfluxDB: `measurement,tag=value field=1.5,other=2 1623403945000000000`.

Source: InfluxData, InfluxDB documentation, "Line protocol".
"""

import re

from rga.errors import InputError
from rga.operation.packets.moments import moment_of_number
from rga.operation.packets.packet import SensorPacket
from rga.operation.packets.readings import SensorReading, check_size, packets_of

_WORD = r"(?:[^\s,=\\]|\\.)+"
_TEXT = r'"(?:[^"\\]|\\.)*"'
_LINE = re.compile(
    rf"(?P<measurement>(?:[^\s,\\]|\\.)+)(?P<tags>(?:,{_WORD}={_WORD})*)"
    rf" +(?P<fields>{_WORD}=(?:{_TEXT}|[^\s,\"]+)(?:,{_WORD}=(?:{_TEXT}|[^\s,\"]+))*)"
    r"(?: +(?P<stamp>-?\d{1,19}))?\s*"
)
_TAG = re.compile(rf",{_WORD}=({_WORD})")
_FIELD = re.compile(rf"({_WORD})=({_TEXT}|[^\s,\"]+)")
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|([+-]?\d+)[iu]")
_ESCAPE = re.compile(r"\\([ ,=\"\\])")
_BOOLEANS = {"t", "T", "true", "True", "TRUE", "f", "F", "false", "False", "FALSE"}


def is_line_protocol(payload: bytes) -> bool:
    """Whether the first line that says something is of the protocol.

    >>> is_line_protocol(b"air,id=1 t=71.2 1623403945000000000"), is_line_protocol(b"time,D1")
    (True, False)
    """
    lines = payload[:20_000].decode("utf-8", "replace").splitlines()
    first = next((line for line in lines if line.strip() and line[0] != "#"), "")
    return _LINE.fullmatch(first) is not None


def read_line_protocol(payload: bytes, where: str, arrived: int) -> list[SensorPacket]:
    """The packets of lines; fields that are texts or booleans are left out.

    A channel is called by the measurement, the values of the tags and the field, with blanks
    between them. Times are of s, ms, us or ns, which their size tells.

    Args:
        payload: lines.
        where: it came from, for an error.
        arrived: of lines without a time, microseconds since 1970 (UTC).

    Raises:
        InputError: a line is not of the protocol, or says what no logger can.

    >>> found = read_line_protocol(b"east,sensor=D1 value=1.5,ok=t 1795392000", "a test", 0)
    >>> found[0].channels, found[0].times.tolist()
    (('east D1 value',), [1795392000000000])
    """
    check_size(payload, where)
    try:
        text = payload.decode()
    except UnicodeDecodeError:
        raise InputError("it is no UTF-8", where, "write line protocol in UTF-8") from None
    points, timed = [], True
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip() or line.startswith("#"):
            continue
        place = f"{where}, line {number}"
        found = _LINE.fullmatch(line)
        if found is None:
            raise InputError(
                "the line is not of the line protocol",
                place,
                "write 'measurement,tag=a field=1 time'",
            )
        if found["stamp"] is None:
            moment, timed = arrived, False
        else:
            moment = moment_of_number(int(found["stamp"]), place)
        series = " ".join([found["measurement"], *_TAG.findall(found["tags"])])
        for field, written in _FIELD.findall(found["fields"]):
            value = _value(written, place)
            if value is not None:
                name = f"{series} {field}"
                name = _ESCAPE.sub(r"\1", name) if "\\" in name else name
                points.append(SensorReading(name, moment, value))
    return packets_of(points, {}, where, timed=timed)


def _value(written: str, where: str) -> float | None:
    """The number of a field; None: it is a text or a boolean."""
    if written.startswith('"') or written in _BOOLEANS:
        return None
    found = _NUMBER.fullmatch(written)
    if found is None:
        raise InputError(f"{written[:40]!r} is no number", where, "write a number")
    return float(found[1] or found[2])
