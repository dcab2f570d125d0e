"""One twin of a service: what its sources send becomes packets, rows, and steps of the twin."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any

from rga.errors import InputError
from rga.jobs.begin import begun
from rga.model import load_model
from rga.operation.configuration import TwinSettings
from rga.operation.disk.forecast import YearlyGrowth, yearly_growth
from rga.operation.inbox.archive import PacketArchive
from rga.operation.inbox.arrival import Arrival, Outcome
from rga.operation.inbox.flow import bytes_a_second
from rga.operation.inbox.known_packets import COUNTED_AGAIN
from rga.operation.inbox.numbers import Numbers
from rga.operation.inbox.packets import Packets
from rga.operation.inbox.row_length import keep_length
from rga.operation.packets.formats import PayloadFormat
from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.overtaken import Overtaken
from rga.operation.rows.remarks import ChannelRemarks
from rga.operation.rows.sealing import Sealing
from rga.operation.service_clock import ServiceClock, microseconds
from rga.operation.sources.arrivals import arrival_of, arrivals_of_lines
from rga.operation.sources.clock import ClockWatch
from rga.operation.sources.opened import opened
from rga.operation.sources.readers import readers_of
from rga.operation.sources.settings import source_name
from rga.operation.sources.source import DataSource, Placed
from rga.settings_files import read_table, validated
from rga.twin.hardware.inbox import Inbox
from rga.twin.settings import Settings


class ServedTwin:
    """A twin with its inbox; what is received is on the disk when `receive` returns.

    Args:
        settings: of the twin.
        directory: of the twin, which is made.
        clock: of the service.

    Attributes:
        model: as it was given.
        archive: packets of long ago.
        inbox: rows and commands that wait for it.
        packets: that have come.

    Raises:
        InputError: its model, its settings or a mapping cannot be used, or another twin is there.
    """

    def __init__(
        self,
        settings: TwinSettings,
        directory: Path,
        clock: ServiceClock,
    ) -> None:
        self.name, self.directory, self._clock = settings.name, directory, clock
        self.model = model = load_model(settings.model)
        run = live_settings(settings.settings, settings.arl0)
        begun(model, directory, settings=run, name=settings.name, seed=settings.seed)
        self._sources = {source_name(one): one for one in settings.source}
        self._readers = readers_of(settings.name, self._sources, model)
        self._clocks = {
            name: ClockWatch(one.clock.rule, settings.rows.lateness)
            for name, one in self._sources.items()
            if one.clock.rule is not None
        }
        self.inbox = Inbox(directory)
        grid = settings.rows.grid
        self.packets = Packets(self.inbox, grid, self._sources)
        keep_length(self.inbox, grid.every, str(directory))
        self._sealing = Sealing(self.inbox, self.packets, model, self._readers, grid)
        self._overtaken = Overtaken(self.packets, self._sources, clock)
        days = None if settings.retention.raw is None else settings.retention.raw / 86_400
        self.archive = PacketArchive(self.inbox, directory, days)
        self._settings, self._packet = settings, run.pace(None).packet
        self._heard = dict.fromkeys(self._sources, clock.monotonic())
        # How old what a source sent last was when it arrived [s].
        self._behind = dict.fromkeys(self._sources, 0.0)
        self._counted_again: dict[str, float] = {}
        # Sources that were silent when rows were last made of all that had come.
        self._sealed_for: set[str] | None = None
        self._lock = Lock()
        self._taking = {name: Lock() for name in self._sources}

    @property
    def source_names(self) -> list[str]:
        """Names of the sources."""
        return list(self._sources)

    @property
    def http_source(self) -> str | None:
        """Name of the source that sends to this service; None: there is none."""
        return next((name for name, one in self._sources.items() if one.kind == "http"), None)

    def sources(self) -> dict[str, DataSource]:
        """Sources by name, not started yet, but for those that send to this service.

        Raises:
            InputError: a secret or a package that one needs is missing.
        """
        names = {*self.model.sensors, *self.model.context}
        found = {
            name: opened(one, self._readers[name].mapping, self.name, names, _TwinInlet(self, name))
            for name, one in self._sources.items()
        }
        return {name: source for name, source in found.items() if source is not None}

    def clock_fault(self, source: str) -> str | None:
        """What is wrong with the clocks of a source, in words; None: nothing."""
        clock = self._clocks.get(source)
        return None if clock is None else clock.fault

    def counts_again(self, source: str) -> bool:
        """Whether a logger of a source has lately begun to count again under the same stream."""
        last = self._counted_again.get(source)
        return last is not None and self._clock.monotonic() - last < self._settings.rows.patience

    def remarks(self, source: str) -> ChannelRemarks:
        """Channels of a source that are not used, or not used as they say."""
        return self._readers[source].remarks

    def receive(
        self,
        source: str,
        payloads: Sequence[Placed],
        cursor: Mapping[str, Any] | None = None,
        kind: PayloadFormat | None = None,
    ) -> list[Outcome]:
        """Keep payloads, each with the place that it came from.

        Args:
            source: name of it.
            payloads: in their order.
            cursor: where the source reads on, by those of its parts that have moved.
            kind: format of the payloads, where the sender says it.

        Returns:
            What becomes of each, and why if it is refused.

        Raises:
            InputError: nothing of them is kept: the disk is full.
        """
        arrived = microseconds(self._clock.now())
        with self._taking[source]:
            arrivals = [
                self._arrival(source, where, payload, arrived, kind) for where, payload in payloads
            ]
            return self._keep(source, arrivals, cursor)

    def receive_lines(
        self, source: str, where: str, head: bytes, lines: bytes, cursor: Mapping[str, Any]
    ) -> list[Outcome]:
        """Keep lines of a file as `receive` does, those that cannot be used apart from the others.

        Args:
            source: name of it.
            where: the file.
            head: lines above all rows.
            lines: of rows.
            cursor: where the source reads on, by those of its parts that have moved.
        """
        arrived = microseconds(self._clock.now())
        parts = [line + b"\n" for line in lines.removesuffix(b"\n").split(b"\n")]
        with self._taking[source]:
            arrivals = arrivals_of_lines(
                head, parts, lambda payload: self._arrival(source, where, payload, arrived, None)
            )
            return self._keep(source, arrivals, cursor)

    def _arrival(
        self, source: str, where: str, payload: bytes, arrived: int, kind: PayloadFormat | None
    ) -> Arrival:
        reader, clock = self._readers[source], self._clocks.get(source)
        return arrival_of(payload, arrived, where, reader, clock, kind)

    def _keep(
        self, source: str, arrivals: Sequence[Arrival], cursor: Mapping[str, Any] | None
    ) -> list[Outcome]:
        clock = self._clocks.get(source)
        try:
            outcomes = self.packets.receive(source, arrivals, cursor)
        except BaseException:
            if clock is not None:
                clock.undo()
            raise
        if clock is not None:
            clock.keep()
        # What cannot be used moves no row on, and is waited for no longer than silence.
        if any(fate in ("waiting", "late") for fate, _ in outcomes):
            self._heard[source] = self._clock.monotonic()
        both = zip(arrivals, outcomes, strict=True)
        taken = [one.arrived - one.last for one, (fate, _) in both if fate == "waiting"]
        if taken:
            self._behind[source] = min(taken) / MICROSECONDS
        if any(why == COUNTED_AGAIN for _, why in outcomes):
            self._counted_again[source] = self._clock.monotonic()
        self._sealed_for = None
        return outcomes

    def numbers(self, source: str) -> dict[str, Numbers]:
        """The numbers that have come of each stream of a source."""
        return self.packets.numbers(source)

    def silence(self, source: str) -> float:
        """How long a source has sent nothing that can be used [s]."""
        return self._clock.monotonic() - self._heard[source]

    @property
    def silent(self) -> set[str]:
        """Sources that have sent nothing that can be used for longer than they are waited for."""
        patience = self._settings.rows.patience
        return {name for name in self._sources if self.silence(name) > patience}

    @property
    def backlog(self) -> float:
        """How old what sources send is when it arrives [s]; 0: no older than they may be late."""
        behind = max((self._behind[one] for one in {*self._sources} - self.silent), default=0.0)
        rows = self._settings.rows
        return behind if behind > max(rows.patience, rows.lateness) else 0.0

    def yearly_growth(self) -> YearlyGrowth:
        """What it takes of the disk in a year, as its sources send now.

        Raises:
            InputError: the inbox cannot be read.
        """
        values = len(self.model.sensors) + len(self.model.context)
        return yearly_growth(self._settings, values, self._packet, bytes_a_second(self.inbox))

    def seal(self) -> int:
        """Make rows of what is final; how many are new."""
        silent = self.silent
        with self._lock:
            if silent == self._sealed_for:
                return 0
            try:
                latest, waits = self._overtaken.latest()
                self._sealed_for = None if waits else silent
                return self._sealing.seal(latest, silent)
            except BaseException:
                self._sealed_for = None
                raise

    def close(self) -> None:
        """Close the file of the inbox."""
        self.inbox.close()


def live_settings(path: Path, arl0: float | None) -> Settings:
    """Settings of a twin that is served: what a diagnosis names is proposed, unless they say so.

    Args:
        path: of their file.
        arl0: rows between false alarms; None: the file says it.

    Raises:
        InputError: the file cannot be read, a setting is unknown or impossible, or false alarms
            are stated twice, or of a detector that knows nothing of them.
    """
    content = {"adopt": "ask"} | read_table(path, "settings")
    if arl0 is not None:
        if "arl0" in content:
            raise InputError(
                "arl0 and false_alarms say the same", str(path), "leave out one of the two"
            )
        content["arl0"] = arl0
    found = validated(Settings, content, str(path), "settings")
    if arl0 is not None and found.detector != "monitor":
        raise InputError(
            f"the detector {found.detector!r} has no rate of false alarms",
            str(path),
            'leave out false_alarms, or take detector = "monitor"',
        )
    return found


@dataclass(frozen=True)
class _TwinInlet:
    """Keeps what one source of a twin brings, as `Inlet` says."""

    twin: ServedTwin
    source: str

    def receive(
        self, payloads: Sequence[Placed], cursor: Mapping[str, Any] | None = None
    ) -> list[Outcome]:
        return self.twin.receive(self.source, payloads, cursor)

    def receive_lines(
        self, where: str, head: bytes, lines: bytes, cursor: Mapping[str, Any]
    ) -> list[Outcome]:
        return self.twin.receive_lines(self.source, where, head, lines, cursor)

    def cursor(self) -> dict[str, Any]:
        return self.twin.packets.cursor(self.source)

    def numbers(self) -> dict[str, Numbers]:
        return self.twin.numbers(self.source)
