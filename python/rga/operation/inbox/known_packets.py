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


class KnownPackets:
    """What is known of the packets of a source, while others of it arrive."""

    def __init__(self, connection: Connection, source: str) -> None:
        self._connection, self._source = connection, source
        self._streams: dict[str, Numbers] = {}
        self._contents: set[str] = set()
        self._moments: dict[Number, tuple[int, int]] = {}

    def fate_of(self, arrival: Arrival, until: int) -> Outcome:
        """What becomes of a packet, and why if it is refused."""
        reason = arrival.refused
        if arrival.number is not None:
            numbers = self._numbers(arrival.number.stream)
            if not numbers.takes(arrival.number.sequence):
                reason = "its number leaves more gaps than are kept of a stream"
            elif not numbers.take(arrival.number.sequence):
                if reason is None and self._is_another(arrival, arrival.number):
                    return "refused", COUNTED_AGAIN
                return "duplicate", None
            else:
                self._moments[arrival.number] = arrival.first, arrival.last
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

    def _is_another(self, arrival: Arrival, number: Number) -> bool:
        """Whether a packet is not the one that had its number before."""
        moments = arrival.first, arrival.last
        if number in self._moments:
            return self._moments[number] != moments
        c = tables.packet.c
        same = (c.stream == number.stream) & (c.sequence == number.sequence)
        chosen = select(c.first, c.last).where((c.source == self._source) & same)
        found = self._connection.execute(chosen).one_or_none()
        if found is not None:
            return tuple(found) != moments
        # The other one was refused, or has gone to the archive since.
        return arrival.last > arrival.arrived - IN_INBOX

    def _has_come(self, sha256: str, arrived: int) -> bool:
        if sha256 in self._contents:
            return True
        c = tables.packet.c
        same = (c.sha256 == sha256) & (c.source == self._source)
        recent = c.arrived.between(arrived - REMEMBERED, arrived + REMEMBERED)
        found = select(c.id).where(same & recent).limit(1)
        return self._connection.execute(found).one_or_none() is not None
