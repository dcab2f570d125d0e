"""By what packets of a source are known again."""

import json

from sqlalchemy import Connection, select

from rga.operation.inbox import tables
from rga.operation.inbox.arrival import Arrival, Outcome
from rga.operation.inbox.numbers import Numbers
from rga.operation.packets.packet import MICROSECONDS, Number
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import put, values_of

#: how long a packet without a number is known again [µs]
REMEMBERED = 24 * 3600 * MICROSECONDS
#: how long the inbox itself keeps packets, to tell them from others of the same number [µs]
IN_INBOX = 7 * REMEMBERED
#: why a packet is refused whose logger began to count again
COUNTED_AGAIN = "its number came before with other times: a logger that counts anew needs a stream"
#: first and last moment of a packet, and what tells its content
_Mark = tuple[int, int, str | None]


class KnownPackets:
    """What is known of the packets of a source, while others of it arrive."""

    def __init__(self, connection: Connection, source: str) -> None:
        self._connection, self._source = connection, source
        self._streams: dict[str, Numbers] = {}
        self._contents: set[str] = set()
        self._marks: dict[Number, _Mark] = {}

    def fate_of(self, arrival: Arrival, until: int) -> Outcome:
        """What becomes of a packet, and why if it is refused."""
        reason = arrival.refused
        if arrival.number is not None:
            numbers = self._numbers(arrival.number.stream)
            if not numbers.takes(arrival.number.sequence):
                reason = "its number leaves more gaps than are kept of a stream"
            elif not numbers.take(arrival.number.sequence):
                other = None if reason else self._other(arrival, arrival.number)
                return ("duplicate", None) if other is None else ("refused", other)
            else:
                self._marks[arrival.number] = _mark_of(arrival)
        elif reason is None and arrival.sha256 is not None:
            if self._has_come(arrival.sha256, arrival.arrived):
                return "duplicate", None
            self._contents.add(arrival.sha256)
        if reason is not None:
            return "refused", reason
        return ("late" if arrival.last < until else "waiting"), None

    def write(self) -> None:
        """Keep the numbers that have come."""
        entries = [
            with_checksum(
                source=self._source, stream=name, next=one.next, gaps=json.dumps(one.gaps)
            )
            for name, one in self._streams.items()
        ]
        put(self._connection, tables.stream, entries, replacing=True)

    def _numbers(self, stream: str) -> Numbers:
        if stream not in self._streams:
            c = tables.stream.c
            where = (c.source == self._source) & (c.stream == stream)
            found = self._connection.execute(select(tables.stream).where(where)).one_or_none()
            known = Numbers()
            if found is not None:
                values = values_of(tables.stream, found)
                known = Numbers(values["next"], map(tuple, json.loads(values["gaps"])))
            self._streams[stream] = known
        return self._streams[stream]

    def _other(self, arrival: Arrival, number: Number) -> str | None:
        """Why a packet is not the one that had its number before; None: it is."""
        known = self._marks.get(number) or self._kept(number)
        if known is None:
            # The other one was refused, or has gone to the archive since.
            return COUNTED_AGAIN if arrival.last > arrival.arrived - IN_INBOX else None
        *moments, content = _mark_of(arrival)
        if list(known[:2]) != moments:
            return COUNTED_AGAIN
        if known[2] in (None, content):
            return None
        return f"stream {number.stream}, packet {number.sequence} came before with other content"

    def _kept(self, number: Number) -> _Mark | None:
        """What is known of the packet of a number in the inbox; None: there is none."""
        c = tables.packet.c
        same = (c.stream == number.stream) & (c.sequence == number.sequence)
        chosen = select(c.first, c.last, c.sha256).where((c.source == self._source) & same)
        found = self._connection.execute(chosen).one_or_none()
        return None if found is None else (found.first, found.last, found.sha256)

    def _has_come(self, sha256: str, arrived: int) -> bool:
        if sha256 in self._contents:
            return True
        c = tables.packet.c
        same = (c.sha256 == sha256) & (c.source == self._source)
        recent = c.arrived.between(arrived - REMEMBERED, arrived + REMEMBERED)
        found = select(c.id).where(same & recent).limit(1)
        return self._connection.execute(found).one_or_none() is not None


def _mark_of(arrival: Arrival) -> _Mark:
    return arrival.first, arrival.last, arrival.sha256
