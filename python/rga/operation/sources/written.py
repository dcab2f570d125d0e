"""Readings that a source of this machine fetches, written as packets of rga's own."""

from collections.abc import Iterable, Iterator

from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import LONGEST, MICROSECONDS
from rga.operation.packets.points import Point, packets_of

#: readings of a payload
MOST_POINTS = 10_000


def payloads_of(points: Iterable[Point], where: str) -> list[bytes]:
    """Packets of readings, each no longer than a packet may be.

    Args:
        points: in any order; those of one channel and moment in the order in which they count.
        where: they came from, for an error.

    >>> len(payloads_of([Point("D1", 0, 1.5), Point("D1", 90_000_000, 2.5)], "a test"))
    2
    """
    payloads = []
    for group in _groups(sorted(points, key=lambda one: one.moment)):
        payloads += [write_packet(one, binary=True) for one in packets_of(group, {}, where)]
    return payloads


def _groups(points: list[Point]) -> Iterator[list[Point]]:
    begin = 0
    for k, point in enumerate(points):
        longest = point.moment - points[begin].moment > LONGEST * MICROSECONDS
        if longest or k - begin >= MOST_POINTS:
            yield points[begin:k]
            begin = k
    if points:
        yield points[begin:]
