"""A number on a topic that names its channel: `site/D1/value` -> `1.5`."""

import re
from datetime import tzinfo
from typing import Any

import msgspec

from rga.errors import InputError
from rga.operation.packets.moments import moment_of_number, moment_of_stamp
from rga.operation.packets.packet import SensorPacket
from rga.operation.packets.readings import SensorReading, packets_of

#: bytes of a number with its time
_MOST = 1000
#: counts of seconds from this one on, in 2001, have ten digits
_LEAST = 10**9
_CHANNEL = "{channel}"
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


class TopicPattern:
    """Where a topic names the channel.

    Args:
        pattern: levels of a topic: {channel} is its name, + is any level.

    Raises:
        ValueError: it does not say {channel} once.

    >>> TopicPattern("site/+/{channel}").channel_of("site/east/D1")
    'D1'
    """

    def __init__(self, pattern: str) -> None:
        levels = pattern.split("/")
        if levels.count(_CHANNEL) != 1 or pattern.count("{") > 1 or "#" in pattern:
            raise ValueError("write {channel} as one level of the topic, and + for any level")
        known = {_CHANNEL: "(?P<channel>[^/]+)", "+": "[^/]+"}
        self._topic = re.compile("/".join(known.get(one, re.escape(one)) for one in levels))
        self._pattern = pattern

    def channel_of(self, topic: str) -> str:
        """The channel that a topic names.

        Raises:
            InputError: the topic is not of the pattern.
        """
        if found := self._topic.fullmatch(topic):
            return found["channel"]
        raise InputError(f"the topic is not of {self._pattern!r}", topic, "correct channel_topic")


def read_number(
    payload: bytes, where: str, arrived: int, pattern: TopicPattern | None, zone: tzinfo | None
) -> list[SensorPacket]:
    """The packet of a number, or of a number and its time.

    Args:
        payload: `1.5`, `1.5 2026-11-23T00:00:00Z` (or `,` or `;` between them; or a time that is
            counted from 1970), or JSON: `{"value": 1.5, "time": ..., "unit": "mm"}`.
        where: the topic.
        arrived: its time where it states none, microseconds since 1970 (UTC).
        pattern: of the topic; None: all of the topic is the name.
        zone: of time stamps that have none.

    Raises:
        InputError: it is no number, or its time cannot be read.

    >>> read_number(b"1.5 1795392000", "site/D1", 0, TopicPattern("site/{channel}"), None)[0].times
    array([1795392000000000])
    """
    channel = where if pattern is None else pattern.channel_of(where)
    value, time, unit = _parts(payload, where)
    moment = arrived
    if isinstance(time, str):
        moment = _moment_of_text(time, zone, where)
    elif time is not None:
        moment = moment_of_number(time, where)
    reading = SensorReading(channel, moment, value)
    return packets_of([reading], {channel: unit or ""}, where, timed=time is not None)


def _moment_of_text(time: str, zone: tzinfo | None, where: str) -> int:
    """Microseconds since 1970 (UTC) of a time that stands behind a number."""
    if _NUMBER.fullmatch(time) is None:
        return moment_of_stamp(time, zone, where)
    if float(time) < _LEAST:
        # What stands behind a comma may as well be the rest of the number.
        words = f"{time!r} behind the number is no time that is counted from 1970"
        raise InputError(words, where, "write numbers with a point, and times with their date")
    return moment_of_number(float(time) if "." in time else int(float(time)), where)


def _parts(payload: bytes, where: str) -> tuple[float, Any, str | None]:
    """A number, and its time and unit if it has them."""
    try:
        if len(payload) > _MOST:
            raise ValueError
        text = payload.decode().strip()
        if text.startswith("{"):
            read = msgspec.json.decode(text, type=_Written)
        else:
            number, *time = re.split(r"\s*[,;]\s*|\s+", text, maxsplit=1)
            if _NUMBER.fullmatch(number) is None:
                raise ValueError
            return float(number), time[0] if time else None, None
    except (ValueError, msgspec.DecodeError, RecursionError):
        shown = payload[:40].decode("utf-8", "replace")
        raise InputError(
            f"{shown!r} is no number", where, "send a number, or a number and its time"
        ) from None
    units = {one for one in (read.unit, read.u) if one}
    if len(units) > 1:
        told = " and ".join(map(repr, sorted(units)))
        raise InputError(f"it is in {told}", where, "state its unit once")
    return float("nan") if read.value is None else read.value, read.time, next(iter(units), None)


class _Written(msgspec.Struct):
    """A number in JSON; other keys, such as the charge of a battery, say nothing of it."""

    value: float | None
    time: int | float | str | None = None
    unit: str | None = None
    u: str | None = None
