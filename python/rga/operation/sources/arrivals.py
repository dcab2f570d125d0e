"""A payload on its way into the inbox: what it is, when it is of, and whether it can be used."""

from hashlib import sha256

from rga.errors import InputError, in_short
from rga.operation.inbox.packets import Arrival, Kind
from rga.operation.packets.native import is_native, read_packet
from rga.operation.rows.samples import Reader
from rga.operation.sources.clock import ClockRule

#: cells of a line of a text: reading it takes the square of them
MOST_CELLS = 1_000
_DELIMITERS = (b",", b";", b"\t", b"|", b" ")


def arrival_of(
    payload: bytes, arrived: int, where: str, reader: Reader, clock: ClockRule | None
) -> Arrival:
    """A payload, read as far as it takes to keep it.

    Args:
        payload: a packet of rga's own, or any format of a logger.
        arrived: microseconds since 1970 (UTC), by the clock of this machine.
        where: it came from, such as a topic: another place, another payload.
        reader: of the source.
        clock: what is believed of its clock; None: all.
    """
    kind: Kind = "file"
    number = None
    try:
        if is_native(payload):
            packet = read_packet(payload, where)
            kind, number, times = "packet", packet.number, packet.times
        else:
            _check_width(payload, where)
            times = reader.of_file(payload).times
    except Exception as error:  # whatever a reader meets, the payload is kept aside
        told = in_short(error)
        return Arrival(payload, kind, arrived, sha256=_digest(where, payload), refused=told)
    first, last = int(times[0]), int(times[-1])
    fault = None if clock is None else clock.fault(first, last, arrived)
    known = None if number else _digest(where, payload)
    return Arrival(payload, kind, arrived, first, last, number, known, fault)


def _check_width(payload: bytes, where: str) -> None:
    """Whether lines of a text have no more cells than loggers write.

    Raises:
        InputError: one has.
    """
    cells = max(line.count(sign) for line in payload.split(b"\n") for sign in _DELIMITERS)
    if cells > MOST_CELLS:
        raise InputError(
            f"a line has {cells} cells, and {MOST_CELLS} are allowed",
            where,
            "send packets of rga's own, or fewer channels at once",
        )


def _digest(where: str, payload: bytes) -> str:
    return sha256(where.encode() + b"\0" + payload).hexdigest()
