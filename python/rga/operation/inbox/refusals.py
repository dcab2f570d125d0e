"""Packets that were kept aside, and why."""

from dataclasses import dataclass

from sqlalchemy import func, select

from rga.operation.inbox import tables
from rga.twin.hardware.inbox import Inbox

#: refusals that are read at once
MOST_READ = 1000


@dataclass(frozen=True)
class Refusal:
    """A packet that cannot be used.

    Attributes:
        id: of it: numbers rise.
        source: that it came from.
        reason: why it cannot be used.
    """

    id: int
    source: str
    reason: str


def last_refusal(inbox: Inbox) -> int:
    """Number of the last packet that was refused; 0: none was."""
    with inbox.reading() as connection:
        return int(connection.scalar(select(func.max(tables.refused.c.id))) or 0)


def refusals_after(inbox: Inbox, id: int) -> list[Refusal]:
    """The packets that were refused after one, without what was sent."""
    c = tables.refused.c
    chosen = select(c.id, c.source, c.reason).where(c.id > id).order_by(c.id).limit(MOST_READ)
    with inbox.reading() as connection:
        return [Refusal(*one) for one in connection.execute(chosen)]
