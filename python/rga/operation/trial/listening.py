"""What sources bring within a few seconds, kept in memory."""

import time
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from threading import Event
from typing import Any

from rga.errors import InputError
from rga.operation.inbox.arrival import Outcome
from rga.operation.inbox.numbers import Numbers
from rga.operation.packets.packet import MOST_BYTES
from rga.operation.sources.opened import opened
from rga.operation.sources.settings import AnySource, FolderSource, MqttSource, SqlSource
from rga.operation.sources.source import DataSource, Placed
from rga.records.mapping import FileMapping

#: how often a source is looked at while it is listened to [s]
OFTEN = 0.2


@dataclass
class TrialInlet:
    """Remembers what one source brings, as an `Inlet` that writes nothing.

    Attributes:
        payloads: each with the place that it came from.
        lines: of files: the place, the lines above all rows, and the rows.
        enough: set when more need not come.
    """

    payloads: list[Placed] = field(default_factory=list)
    lines: list[tuple[str, bytes, bytes]] = field(default_factory=list)
    enough: Event = field(default_factory=Event)
    _bytes: int = 0

    def receive(
        self, payloads: Sequence[Placed], cursor: Mapping[str, Any] | None = None
    ) -> list[Outcome]:
        """Remember payloads, until there are enough."""
        for place, payload in payloads:
            if self._has_room(len(payload)):
                self.payloads.append((place, payload))
        return []

    def receive_lines(
        self, where: str, head: bytes, lines: bytes, cursor: Mapping[str, Any]
    ) -> list[Outcome]:
        """Remember lines, until there are enough."""
        if self._has_room(len(lines)):
            self.lines.append((where, head, lines))
        return []

    def cursor(self) -> dict[str, Any]:
        """Nothing was read before."""
        return {}

    def numbers(self) -> dict[str, Numbers]:
        """Nothing is acknowledged."""
        return {}

    @property
    def is_empty(self) -> bool:
        """Whether nothing has come."""
        return not self.payloads and not self.lines

    def _has_room(self, size: int) -> bool:
        if self._bytes + size > MOST_BYTES:
            self.enough.set()
            return False
        self._bytes += size
        return True


@dataclass(frozen=True)
class Heard:
    """What came of a source.

    Attributes:
        inlet: what it brought.
        error: why it cannot be listened to; None: it can.
        fault: what kept data from coming at the end, in words; None: nothing.
    """

    inlet: TrialInlet
    error: InputError | None = None
    fault: str | None = None


#: name of a twin, those of its sensors and contexts, a source of it, and the mapping of its logger
Listened = tuple[str, Collection[str], AnySource, FileMapping]


def listened_to(sources: Sequence[Listened], wait: float) -> list[Heard]:
    """What sources bring, all at once.

    Args:
        sources: of twins.
        wait: how long they are listened to [s].
    """
    inlets = [TrialInlet() for _ in sources]
    errors: list[InputError | None] = []
    running: list[DataSource | None] = []
    for source, inlet in zip(sources, inlets, strict=True):
        try:
            running.append(_listener(*source, inlet))
            errors.append(None)
        except InputError as error:
            running.append(None)
            errors.append(error)
    begun = [found for found in running if found is not None]
    for found in begun:
        found.start()
    until = time.monotonic() + wait
    listening = [inlet for inlet, one in zip(inlets, running, strict=True) if one is not None]
    while time.monotonic() < until and not all(one.enough.is_set() for one in listening):
        time.sleep(OFTEN / 4)
    # What a source says as it is stopped is no fault.
    faults = [None if one is None else one.fault for one in running]
    for found in begun:
        found.stop()
    return [Heard(*one) for one in zip(inlets, errors, faults, strict=True)]


def _listener(
    twin: str,
    names: Collection[str],
    source: AnySource,
    mapping: FileMapping,
    inlet: TrialInlet,
) -> DataSource | None:
    """What listens to a source and leaves nothing there; None: it sends to the service."""
    if isinstance(source, MqttSource):
        from rga.operation.trial.broker_visit import BrokerVisit

        return BrokerVisit(source, inlet)
    if isinstance(source, (FolderSource, SqlSource)):
        source = source.model_copy(update={"poll": OFTEN})
    return opened(source, mapping, twin, names, inlet)
