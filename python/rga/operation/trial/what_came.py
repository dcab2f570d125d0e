"""Whether a twin can use what its sources have brought."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

from rga.checking.finding import Finding, Severity, named
from rga.model import Model
from rga.operation.inbox.arrival import Arrival
from rga.operation.packets.formats import PACKETS
from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.cells import SensorSamples
from rga.operation.rows.samples import Reader
from rga.operation.sources.arrivals import arrival_of, arrivals_of_lines
from rga.operation.sources.clock import in_words
from rga.operation.sources.settings import AnySource
from rga.operation.trial.listening import Heard, TrialInlet

#: payloads that cannot be used of which each is told why
MOST_TOLD = 3


@dataclass
class WhatCame:
    """What one source has brought, as its twin would read it.

    Attributes:
        samples: in the units of the model.
        size: of the payloads that can be used [bytes].
        first, last: moments of their readings, microseconds since 1970 (UTC); None: none came.
        refused: why payloads cannot be used, each reason once.
        stated: sensors and contexts of columns that the configuration states.
    """

    samples: list[SensorSamples] = field(default_factory=list)
    size: int = 0
    first: int | None = None
    last: int | None = None
    refused: dict[str, str] = field(default_factory=dict)
    stated: set[str] = field(default_factory=set)

    @property
    def names(self) -> set[str]:
        """Sensors and contexts that were read, or are stated to come."""
        return self.stated.union(*(one.names for one in self.samples))

    def take(self, arrival: Arrival, reader: Reader) -> None:
        """Take one payload in."""
        if arrival.refused is not None:
            self.refused.setdefault(arrival.refused, arrival.place)
            return
        self.size += len(arrival.payload)
        self.first = arrival.first if self.first is None else min(self.first, arrival.first)
        self.last = arrival.last if self.last is None else max(self.last, arrival.last)
        told = (arrival.kind, arrival.payload, arrival.place, arrival.arrived)
        if arrival.kind in PACKETS:
            self.samples += reader.of_packets(reader.packets_of(*told))
        else:
            self.samples.append(reader.of_rows(*told)[0])


def what_came(inlet: TrialInlet, reader: Reader, now: int) -> WhatCame:
    """Read what a source has brought.

    Args:
        inlet: that it was brought to.
        reader: of the source.
        now: microseconds since 1970 (UTC).
    """
    found = WhatCame(stated=reader.stated_names())
    for place, payload in inlet.payloads:
        found.take(_arrival(now, place, reader, payload), reader)
    for where, head, lines in inlet.lines:
        parts = [line + b"\n" for line in lines.removesuffix(b"\n").split(b"\n")]
        arrive = partial(_arrival, now, where, reader)
        for one in arrivals_of_lines(head, parts, arrive):
            found.take(one, reader)
    return found


def _arrival(now: int, place: str, reader: Reader, payload: bytes) -> Arrival:
    # Whatever a clock says: it is looked at by itself.
    return arrival_of(payload, now, place, reader, None)


def source_findings(
    where: str, source: AnySource, heard: Heard, came: WhatCame, reader: Reader, wait: float
) -> Iterator[Finding]:
    """What is wrong with a source, and with what it has brought.

    Args:
        where: of which twin it is.
        source: its settings.
        heard: what was heard of it.
        came: what of that can be used.
        reader: of the source, which has read it.
        wait: how long it was listened to [s].
    """
    yield from channel_findings(where, reader)
    if source.kind == "http":
        what = "loggers send to the service: nothing can be heard before it runs"
        yield Finding("note", where, what, "look at the page Data when it runs")
        return
    if heard.fault is not None:
        yield Finding("error", where, heard.fault, "mend it there, or correct the source")
    elif heard.inlet.is_empty:
        what = f"nothing came within {wait:g} s"
        yield Finding(
            "warning", where, what, "see whether the logger sends, or give a longer --wait"
        )
    for why, place in list(came.refused.items())[:MOST_TOLD]:
        what = f"what came from {place} cannot be used: {why}"
        yield Finding("error", where, what, "correct format or mapping of the source")


def channel_findings(where: str, reader: Reader) -> Iterator[Finding]:
    """Channels that are not used, or not as they say."""
    for channel in reader.mapping.overruled:
        what = f"the channel {channel!r} is left out: [unused] names it as well as [channels]"
        remedy = "leave it out of [unused] where it is to be read"
        yield Finding("warning", where, what, remedy)
    for channel, why in reader.remarks.refused.items():
        what = f"the channel {channel!r} is not used: {why}"
        remedy = "name it under [channels] or [unused] in import.toml"
        yield Finding("error", where, what, remedy)
    for channel, why in reader.remarks.doubted.items():
        remedy = "correct the one that is wrong, or leave the unit out of import.toml"
        yield Finding("warning", where, f"the channel {channel!r}: {why}", remedy)


def clock_findings(where: str, source: AnySource, came: WhatCame, now: int) -> Iterator[Finding]:
    """What the times of the newest readings say of the clock of a logger."""
    rule = source.clock.rule
    if rule is None or came.last is None:
        return
    offset = (now - came.last) / MICROSECONDS
    if (fault := rule.fault(came.last, came.last, now)) is not None:
        remedy = "set the clock of the logger (to UTC), or the clock of the source"
        yield Finding("error", where, f"{fault}: they are refused", remedy)
    elif abs(offset) > rule.tolerance:
        what = f"its newest reading is {in_words(offset)} old"
        yield Finding("warning", where, what, "see whether the logger sends, and its clock")


def silent_findings(
    where: str,
    model: Model,
    sources: Sequence[AnySource],
    came: Sequence[WhatCame],
    readers: Sequence[Reader],
) -> Iterator[Finding]:
    """Sensors of a model of which nothing came, nor is stated to come."""
    pairs = zip(sources, came, strict=True)
    sent: set[str] = set().union(*(one.names for one in came))
    if not sent or any(source.kind == "http" and not one.stated for source, one in pairs):
        return
    left_out = frozenset.intersection(*(one.left_out for one in readers))
    if silent := [one for one in model.sensors if one not in sent | left_out]:
        # Loggers of a broker may send later; files, tables and servers show all that they have.
        severity: Severity = "warning" if any(one.kind == "mqtt" for one in sources) else "error"
        remedy = "correct [channels] in import.toml, or list them under [unused] with the reason"
        yield Finding(severity, where, f"nobody sends {named(silent)}", remedy)
