"""Packets that cannot be used, and why."""

from dataclasses import dataclass

from sqlalchemy import select

from rga.operation.inbox import tables
from rga.twin.hardware.inbox import Inbox
from rga.twin.repository.faults import whole


@dataclass(frozen=True)
class RefusedPacket:
    """A packet that cannot be used.

    Attributes:
        source: that it came from.
        arrived: microseconds since 1970 (UTC), by the clock of this machine.
        reason: why it cannot be used.
        payload: how it begins.
    """

    source: str
    arrived: int
    reason: str
    payload: bytes


def refused_packets(inbox: Inbox, most: int) -> list[RefusedPacket]:
    """The latest packets of a twin that cannot be used, the last first.

    Args:
        inbox: of the twin.
        most: how many.
    """
    chosen = select(tables.refused).order_by(tables.refused.c.id.desc()).limit(most)
    with inbox.reading() as connection:
        found = [whole(tables.refused, one) for one in connection.execute(chosen)]
    return [RefusedPacket(one.source, one.arrived, one.reason, one.payload) for one in found]
