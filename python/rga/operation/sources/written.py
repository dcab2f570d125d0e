"""Readings that a source of this machine fetches, written as packets of rga's own."""

from collections.abc import Iterable, Iterator

from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import LONGEST, MICROSECONDS
from rga.operation.packets.readings import SensorReading, packets_of

#: readings of a payload
MOST_READINGS = 10_000


def payloads_of(points: Iterable[SensorReading], where: str) -> list[bytes]:
    """Packets of readings, each no longer than a packet may be.

    Args:
        points: in any order; those of one channel and moment in the order in which they count.
        where: they came from, for an error.

    >>> minutes = [SensorReading("D1", moment, 1.5) for moment in (0, 90_000_000)]
    >>> len(payloads_of(minutes, "a test"))
    2
    """
    payloads = []
    for group in _groups(sorted(points, key=lambda one: one.moment)):
        payloads += [write_packet(one, binary=True) for one in packets_of(group, {}, where)]
    return payloads


def _groups(points: list[SensorReading]) -> Iterator[list[SensorReading]]:
    begin = 0
    for k, point in enumerate(points):
        longest = point.moment - points[begin].moment > LONGEST * MICROSECONDS
        if longest or k - begin >= MOST_READINGS:
            yield points[begin:k]
            begin = k
    if points:
        yield points[begin:]
