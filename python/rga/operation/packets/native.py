"""The packet of rga's own, as JSON or MessagePack."""

import json
import re
from datetime import datetime, timedelta
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.operation.packets.packet import (
    EPOCH,
    LONGEST,
    MICROSECONDS,
    MOST_BYTES,
    MOST_CHANNELS,
    Moments,
    Number,
    SensorPacket,
)
from rga.records.record import LARGEST

#: name of a stream
STREAM_PATTERN = r"^[A-Za-z0-9._-]{1,64}$"
_Name = Annotated[str, Meta(min_length=1, max_length=200)]


class NativePacket(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """A packet as it is written; `read_packet` gives what it says.

    Attributes:
        v: version of the format.
        t0: time of the first row, with its zone.
        channels: names, as the logger calls them.
        values: a list of readings for each row, null where one is missing; or all of them as
            little-endian float32, row by row, NaN where one is missing (base64 in JSON).
        dt: time between the rows [s].
        t: seconds of each row since `t0`, rising, in place of `dt`; a single row needs neither.
        stream: drawn at random by the logger when it starts.
        seq: number of the packet within the stream, counted from 0, below 2**53.
    """

    v: Literal[1]
    t0: Annotated[datetime, Meta(tz=True)]
    channels: Annotated[list[_Name], Meta(min_length=1, max_length=MOST_CHANNELS)]
    values: bytes | Annotated[list[list[float | None]], Meta(min_length=1)]
    dt: Annotated[float, Meta(gt=0, le=LONGEST)] | None = None
    t: list[float] | None = None
    stream: Annotated[str, Meta(pattern=STREAM_PATTERN)] | None = None
    seq: Annotated[int, Meta(ge=0, lt=2**53)] | None = None


_JSON = msgspec.json.Decoder(NativePacket)
_MESSAGE_PACK = msgspec.msgpack.Decoder(NativePacket)
#: its keys as they stand in JSON
_QUOTED = [f'"{name}"'.encode() for name in NativePacket.__struct_fields__]


def packet_schema() -> dict[str, Any]:
    """JSON Schema of a packet.

    >>> packet_schema()["title"]
    'packet'
    """
    schema = msgspec.json.schema(NativePacket)
    known = schema["$defs"].pop("NativePacket")
    draft = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": draft, **known, "title": "packet"}


def is_native(payload: bytes) -> bool:
    """Whether bytes are to be a packet: a map of MessagePack, or a JSON object with a version.

    >>> is_native(b' {"v": 1}'), is_native(b"time,D1"), is_native(b'{"Datastream": {}}')
    (True, False, False)
    """
    return payload[:1] in _MAPS or _OBJECT.match(payload) is not None


#: a JSON object that says its version before anything that is nested
_OBJECT = re.compile(rb'\s*\{[^\[{]*"v"\s*:')
_MAPS = {bytes([one]) for one in (*range(0x80, 0x90), 0xDE, 0xDF)}


def read_packet(payload: bytes, where: str) -> SensorPacket:
    """The packet that bytes say.

    Args:
        payload: JSON or MessagePack.
        where: it came from, for an error.

    Raises:
        InputError: it is none, or says what no logger can.

    >>> text = '{"v": 1, "t0": "2026-11-23T00:00:00Z", "channels": ["D1"], "values": [[0.5]]}'
    >>> read_packet(text.encode(), "a test").values.tolist()
    [[0.5]]
    """
    if len(payload) > MOST_BYTES:
        raise InputError(
            f"the packet has {len(payload)} bytes, and {MOST_BYTES} are allowed",
            where,
            "send fewer rows at once",
        )
    try:
        written = (_MESSAGE_PACK if payload[:1] in _MAPS else _JSON).decode(payload)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError, OverflowError) as error:
        why = str(error)[:200] or "it is nested too deep"
        if payload[:1] not in _MAPS and payload.lstrip()[:1] != b"{":
            why = "it begins neither as an object of JSON nor as a map of MessagePack"
        raise InputError(
            f"this is no packet: {why}",
            where,
            "write it as `rga schema packet` says",
        ) from None
    _check_keys(payload, where)
    channels = tuple(written.channels)
    if len(set(channels)) < len(channels):
        double = next(name for name in channels if channels.count(name) > 1)
        raise InputError(f"the channel {double!r} stands twice", where, "name every channel once")
    if (written.stream is None) != (written.seq is None):
        lacking = "stream" if written.stream is None else "seq"
        raise InputError(
            f"it has no {lacking}", where, "give stream and seq, or neither of the two"
        )
    values = _values(written, where)
    number = None
    if written.stream is not None and written.seq is not None:
        number = Number(written.stream, written.seq)
    return SensorPacket(number, channels, _times(written, len(values), where), values)


def write_packet(packet: SensorPacket, *, binary: bool = False, single: bool = False) -> bytes:
    """A packet as JSON, or as MessagePack.

    Args:
        packet: of at least one row.
        binary: MessagePack.
        single: readings as float32: half as long, and seven digits of each.

    >>> packet = SensorPacket(None, ("D1",), np.array([0]), np.array([[0.5]]))
    >>> read_packet(write_packet(packet, binary=True, single=True), "a test").times.tolist()
    [0]
    """
    count = len(packet.times)
    since = (packet.times - packet.times[0]) / MICROSECONDS
    steps = np.unique(np.diff(packet.times))
    values: Any = packet.values.astype("<f4").tobytes()
    if not single:
        rows = packet.values.tolist()
        values = [[None if one != one else one for one in row] for row in rows]
    written = NativePacket(
        v=1,
        t0=EPOCH + timedelta(microseconds=int(packet.times[0])),
        channels=list(packet.channels),
        values=values,
        dt=float(steps[0]) / MICROSECONDS if len(steps) == 1 else None,
        t=since.tolist() if count > 1 and len(steps) > 1 else None,
        stream=packet.number.stream if packet.number else None,
        seq=packet.number.sequence if packet.number else None,
    )
    said = {
        name: value for name, value in msgspec.structs.asdict(written).items() if value is not None
    }
    return msgspec.msgpack.encode(said) if binary else msgspec.json.encode(said)


def _check_keys(payload: bytes, where: str) -> None:
    """Whether every key of a packet in JSON stands once.

    Raises:
        InputError: one stands twice.
    """
    if payload[:1] in _MAPS:
        return
    # A name may be written by escapes; else a key that stands twice is found twice.
    if b"\\u" not in payload and max(map(payload.count, _QUOTED)) < 2:
        return
    keys = [key for key, _ in json.loads(payload, object_pairs_hook=list)]
    if double := next((key for key in keys if keys.count(key) > 1), None):
        raise InputError(f"the key {double!r} stands twice", where, "write every key once")


def _values(written: NativePacket, where: str) -> FloatArray:
    """Readings, float64[n, channels]."""
    channels = len(written.channels)
    if isinstance(written.values, bytes):
        rows, rest = divmod(len(written.values), 4 * channels)
        if rest or not rows:
            raise InputError(
                f"{len(written.values)} bytes are no rows of {channels} float32 each",
                where,
                "write 4 bytes for every channel of every row",
            )
        values = np.frombuffer(written.values, "<f4").reshape(rows, channels).astype(float)
    else:
        lengths = {len(row) for row in written.values}
        if lengths != {channels}:
            other = min(lengths - {channels})
            raise InputError(
                f"a row has {other} readings, and there are {channels} channels",
                where,
                "write null where a reading is missing",
            )
        values = np.array(written.values, dtype=float)
    if (np.abs(values) > LARGEST).any():
        raise InputError(
            f"nothing measures {np.nanmax(np.abs(values)):g}",
            where,
            "write null, or NaN in float32, where a reading is missing",
        )
    return values


def _times(written: NativePacket, rows: int, where: str) -> Moments:
    """Moments of the rows, int64[n]."""
    if written.t is not None and written.dt is not None:
        raise InputError("it has dt and t", where, "give one of the two")
    start = (written.t0 - EPOCH) // timedelta(microseconds=1)
    if rows == 1 and written.t is None:
        return np.array([start])
    if written.t is None:
        if written.dt is None:
            raise InputError(f"{rows} rows have no times", where, "give dt or t")
        since = np.arange(rows) * written.dt
    else:
        since = np.array(written.t, dtype=float)
        if len(since) != rows:
            raise InputError(f"{rows} rows have {len(since)} times", where, "give a time a row")
    if not (np.abs(since) <= LONGEST).all():
        raise InputError(
            f"the packet is longer than {LONGEST:g} s", where, "send what is measured sooner"
        )
    after = np.rint(since * MICROSECONDS).astype(np.int64)
    if (np.diff(after) <= 0).any():
        raise InputError(
            "its times do not rise by a microsecond at least", where, "write rows as they follow"
        )
    return np.asarray(start + after)
