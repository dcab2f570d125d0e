"""A payload on its way into the inbox: what it is, when it is of, and whether it can be used."""

from collections.abc import Callable, Sequence
from hashlib import sha256

from rga.errors import InputError, in_short
from rga.operation.inbox.arrival import Arrival
from rga.operation.packets.formats import PACKETS, PayloadFormat
from rga.operation.rows.samples import Reader, check_samples
from rga.operation.sources.clock import ClockSight, ClockWatch

#: cells of a line of a text: reading it takes the square of them
MOST_CELLS = 1_000
#: what mends a clock that is not believed
_MEND = "set the clock of the logger, or state another clock of the source"
_DELIMITERS = (b",", b";", b"\t", b"|", b" ")


def arrival_of(
    payload: bytes,
    arrived: int,
    where: str,
    reader: Reader,
    clock: ClockWatch | None,
    kind: PayloadFormat | None = None,
) -> Arrival:
    """A payload, read as far as it takes to keep it.

    Args:
        payload: a packet of rga's own, or any format of a logger.
        arrived: microseconds since 1970 (UTC), by the clock of this machine.
        where: it came from, such as a topic: another place, another payload.
        reader: of the source.
        clock: what is believed of its clock; None: all.
        kind: its format, where the sender says it.
    """
    kind = reader.format_of(payload, kind)
    number = digest = None
    try:
        if kind in PACKETS:
            packets = reader.packets_of(kind, payload, where, arrived)
            reader.check_used(packets, where)
            number, timed = packets[0].number, all(one.timed for one in packets)
            digest = None if number is None else packets[0].sha256
            # The times of a packet rise.
            first = min(int(one.times[0]) for one in packets)
            last = max(int(one.times[-1]) for one in packets)
            channels = frozenset(name for one in packets for name in one.channels)
        else:
            _check_width(payload, where)
            samples, timed = reader.of_rows(kind, payload, where, arrived)
            check_samples(samples, where)
            channels = frozenset(samples.names)
            first, last = int(samples.times.min()), int(samples.times.max())
    except Exception as error:  # whatever a reader meets, the payload is kept aside
        told = in_short(error)
        return Arrival(payload, kind, arrived, refused=told, place=where)
    fault = None
    if clock is not None:
        fault = clock.refused(ClockSight(where, channels, number, first, last, arrived))
        fault = fault and f"{fault}: {_MEND}"
    # The same number may be sent again and again, and is another reading each time.
    if timed and number is None:
        digest = sha256(where.encode() + b"\0" + payload).hexdigest()
    return Arrival(payload, kind, arrived, first, last, number, digest, fault, where)


#: lines beyond which not every one is looked at where the first, the last and one between them
#: cannot be used
FEW = 16


def arrivals_of_lines(
    head: bytes, lines: Sequence[bytes], arrive: Callable[[bytes], Arrival]
) -> list[Arrival]:
    """Lines of a file as few payloads: those that cannot be used are apart from the others.

    Args:
        head: lines above all rows, which every payload begins with.
        lines: each with its end.
        arrive: reads a payload.
    """
    whole = arrive(head + b"".join(lines))
    if whole.refused is None or len(lines) == 1:
        return [whole]
    middle = len(lines) // 2
    if len(lines) > FEW:
        some = (lines[0], lines[middle], lines[-1])
        if all(arrive(head + line).refused is not None for line in some):
            return [whole]
    first = arrivals_of_lines(head, lines[:middle], arrive)
    return first + arrivals_of_lines(head, lines[middle:], arrive)


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
