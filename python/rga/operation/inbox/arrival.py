"""A packet as it arrives, and what becomes of it."""

from dataclasses import dataclass
from typing import Literal

from rga.operation.packets.formats import PayloadFormat
from rga.operation.packets.packet import Number

Fate = Literal["waiting", "late", "duplicate", "refused"]
#: what becomes of a packet, and why if it is refused
Outcome = tuple[Fate, str | None]


@dataclass(frozen=True)
class Arrival:
    """A packet as it arrives.

    Attributes:
        payload: as it was sent.
        kind: by which it is read again.
        arrived: microseconds since 1970 (UTC), by the clock of this machine.
        place: that it came from, such as a topic, without which it cannot be read again.
        first, last: moments of its samples, microseconds since 1970 (UTC).
        number: None: the logger counts none.
        sha256: of what tells it from others; None: it is told from none, or by its number alone.
        refused: why it cannot be used; None: it can.
    """

    payload: bytes
    kind: PayloadFormat
    arrived: int
    first: int = 0
    last: int = 0
    number: Number | None = None
    sha256: str | None = None
    refused: str | None = None
    place: str = ""
