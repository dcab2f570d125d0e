"""Readings that come one by one, each with a channel and a time, as packets."""

import json
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from rga.bounded_files import fault_of
from rga.errors import InputError
from rga.operation.packets.packet import MICROSECONDS, MOST_BYTES, MOST_CHANNELS, SensorPacket
from rga.operation.settings_types import is_readable
from rga.records.record import LARGEST

#: longest time of a payload of others [s]: what keeps readings while the network is away sends
#: them in batches, and knows nothing of the limit of a packet of rga's own
LONGEST_BATCH = 86_400.0
LONGEST_NAME = 200


class SensorReading(NamedTuple):
    """One reading.

    Attributes:
        channel: as the logger calls it.
        moment: microseconds since 1970 (UTC).
        value: NaN where it is missing.
    """

    channel: str
    moment: int
    value: float


def packets_of(
    points: Iterable[SensorReading], units: Mapping[str, str], where: str, *, timed: bool = True
) -> list[SensorPacket]:
    """Packets of readings: channels of the same moments together.

    Where a channel has several values of one moment, each is in a packet of its own, in their
    order.

    Args:
        points: in the order in which they are written.
        units: by channel, where they are stated.
        where: they came from, for an error.
        timed: False: at least one is of when it arrived.

    Raises:
        InputError: there is none, or one that no logger can mean.

    >>> sent = [("D1", 5, 1.5), ("D2", 5, 2.5), ("D1", 5, 3.5)]
    >>> found = packets_of([SensorReading(*one) for one in sent], {}, "a test")
    >>> [(one.channels, one.values.tolist()) for one in found]
    [(('D1', 'D2'), [[1.5, 2.5]]), (('D1',), [[3.5]])]
    """
    layers: dict[str, list[dict[int, float]]] = {}
    for channel, moment, value in points:
        if abs(value) > LARGEST:
            raise InputError(
                f"{channel[:40]!r}: nothing measures {value:g}",
                where,
                "leave a reading out where it is missing",
            )
        own = layers.setdefault(channel, [{}])
        layer = own[0]
        if moment in layer:
            layer = next((one for one in own if moment not in one), {})
            if not layer:
                own.append(layer)
        layer[moment] = value
    _check(layers, where)
    alike: dict[tuple[int, tuple[int, ...]], dict[str, dict[int, float]]] = {}
    for channel, own in layers.items():
        for number, layer in enumerate(own):
            alike.setdefault((number, tuple(sorted(layer))), {})[channel] = layer
    return [
        SensorPacket(
            None,
            tuple(columns),
            np.array(moments, dtype=np.int64),
            np.array([[one[moment] for one in columns.values()] for moment in moments]),
            {name: units[name] for name in columns if units.get(name)},
            timed,
        )
        for (_, moments), columns in sorted(alike.items(), key=lambda one: one[0][0])
    ]


def check_size(payload: bytes, where: str) -> None:
    """Refuse a payload that is longer than any packet, before anything of it is read."""
    if len(payload) > MOST_BYTES:
        raise InputError(
            f"it has {len(payload)} bytes, and {MOST_BYTES} are allowed",
            where,
            "send fewer rows at once",
        )


def _check(layers: Mapping[str, list[dict[int, float]]], where: str) -> None:
    if not layers:
        raise InputError("there is no number in it", where, "send at least one reading")
    if len(layers) > MOST_CHANNELS:
        raise InputError(
            f"it has {len(layers)} channels, and {MOST_CHANNELS} are allowed",
            where,
            "send fewer channels at once",
        )
    if wrong := next((one for one in layers if not 0 < len(one) <= LONGEST_NAME), None):
        raise InputError(
            f"the name {wrong[:20]!r}... has {len(wrong)} letters, and {LONGEST_NAME} are allowed",
            where,
            "give it a shorter one",
        )
    if "" in layers:
        raise InputError("a reading has no name", where, "name its channel")
    moments = [moment for own in layers.values() for layer in own for moment in layer]
    span = (max(moments) - min(moments)) / MICROSECONDS
    if span > LONGEST_BATCH:
        raise InputError(
            f"it is of {span:g} s, and {LONGEST_BATCH:g} are allowed",
            where,
            "send what is measured sooner",
        )


def check_json(payload: bytes, where: str) -> None:
    """Whether what begins as JSON is JSON.

    Raises:
        InputError: it begins so, and is none.
    """
    if payload.lstrip()[:1] not in (b"{", b"["):
        return
    try:
        json.loads(payload)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"this is no JSON: {fault_of(error)}", where, "send the whole of it, as JSON is written"
        ) from None


def check_names(names: Iterable[str], where: str) -> None:
    """Whether names can be shown to people.

    Raises:
        InputError: one has a control character.
    """
    for name in names:
        if not is_readable(name) or "\n" in name:
            raise InputError(
                f"the name {name!r} has a control character", where, "name it by visible letters"
            )
