"""How much loggers send."""

from collections import defaultdict

from sqlalchemy import func, select

from rga.operation.inbox import tables
from rga.operation.packets.packet import MICROSECONDS
from rga.twin.hardware.inbox import Inbox

#: packets that tell, the latest of a twin
LOOKED_AT = 2000


def bytes_a_second(inbox: Inbox) -> float:
    """What all sources of a twin send in a second of their own time; 0: too little came to tell.

    Raises:
        InputError: the inbox cannot be read.
    """
    c = tables.packet.c
    # What came late is of another time.
    chosen = select(c.source, c.last, func.length(c.payload)).where(c.fate != "late")
    found: dict[str, list[tuple[int, int]]] = defaultdict(list)
    with inbox.reading() as connection:
        for source, last, size in connection.execute(chosen.order_by(c.id.desc()).limit(LOOKED_AT)):
            found[source].append((last, size))
    return sum(map(_rate, found.values()))


def _rate(packets: list[tuple[int, int]]) -> float:
    """Bytes a second of packets, each of which brings what was measured since the one before."""
    (begin, first), (end, _) = min(packets), max(packets)
    size = sum(size for _, size in packets) - first
    return size * MICROSECONDS / (end - begin) if end > begin else 0.0
