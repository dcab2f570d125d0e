"""Which format a payload has, and reading it."""

import re
from dataclasses import dataclass
from datetime import tzinfo
from typing import Literal

from rga.operation.packets.line_protocol import is_line_protocol, read_line_protocol
from rga.operation.packets.native import is_native, read_packet
from rga.operation.packets.packet import SensorPacket
from rga.operation.packets.senml import read_senml
from rga.operation.packets.sensorthings import read_sensorthings
from rga.operation.packets.topics import TopicPattern, read_number

#: how a payload is read: as a packet of rga's own, as one of a format of others, as a row whose
#: columns are stated, or as a file in any format of a logger
PayloadFormat = Literal["packet", "senml", "sensorthings", "line_protocol", "number", "row", "file"]
#: formats whose payloads are read as packets; the others are read as files
PACKETS = ("packet", "senml", "sensorthings", "line_protocol", "number")
#: formats that a Content-Type of HTTP names
TYPES: dict[str, PayloadFormat] = {
    "application/vnd.rga.packet+json": "packet",
    "application/msgpack": "packet",
    "application/vnd.msgpack": "packet",
    "application/x-msgpack": "packet",
    "application/senml+json": "senml",
    "application/vnd.influx.line-protocol": "line_protocol",
    "text/csv": "file",
}
_RECORD = re.compile(rb'\s*\[\s*\{\s*"(?:b[ntuvs]|bver|n|u|v|vs|vb|vd|s|t|ut)"\s*:')
_OBSERVATION = re.compile(rb'\s*[{\[].{0,4000}"(?:dataArray|phenomenonTime|Datastream[^"]*)"', re.S)


def format_of_type(content_type: str | None) -> PayloadFormat | None:
    """The format that a Content-Type of HTTP names; None: it names none.

    >>> format_of_type("application/senml+json; charset=utf-8"), format_of_type("text/plain")
    ('senml', None)
    """
    named = (content_type or "").partition(";")[0].strip().lower()
    return TYPES.get(named)


def format_of_bytes(payload: bytes) -> PayloadFormat:
    """The format that a payload seems to have.

    >>> format_of_bytes(b'[{"n": "D1", "v": 1.5}]'), format_of_bytes(b"time,D1")
    ('senml', 'file')
    """
    if is_native(payload):
        return "packet"
    if _RECORD.match(payload):
        return "senml"
    if _OBSERVATION.match(payload):
        return "sensorthings"
    if is_line_protocol(payload):
        return "line_protocol"
    return "file"


@dataclass(frozen=True)
class StatedFormat:
    """What a configuration states of the payloads of a source.

    Attributes:
        format: of all of them; None: each is looked at.
        pattern: of topics that name a channel.
        columns: of rows that are sent without their names, or channels that a server is asked for.
        zone: of time stamps that have none.
    """

    format: PayloadFormat | None = None
    pattern: TopicPattern | None = None
    columns: tuple[str, ...] = ()
    zone: tzinfo | None = None


def read_packets(
    kind: PayloadFormat, payload: bytes, where: str, arrived: int, stated: StatedFormat
) -> list[SensorPacket]:
    """The packets that a payload says.

    Args:
        kind: one of `PACKETS`.
        payload: as it was sent.
        where: it came from, such as a topic.
        arrived: microseconds since 1970 (UTC), the time of what has no time of its own.
        stated: of payloads of its source.

    Raises:
        InputError: it is no such payload, or says what no logger can.
    """
    if kind == "senml":
        return read_senml(payload, where, arrived)
    if kind == "sensorthings":
        return read_sensorthings(payload, where, arrived, stated.zone)
    if kind == "line_protocol":
        return read_line_protocol(payload, where, arrived)
    if kind == "number":
        return read_number(payload, where, arrived, stated.pattern, stated.zone)
    return [read_packet(payload, where)]
