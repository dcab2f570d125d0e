"""The service: sources, rows, workers, alarms and notices, from the start to the end."""

from collections.abc import Callable
from functools import partial
from threading import Event, Thread
from typing import TYPE_CHECKING

from rga.operation.alarms import tables as alarm_tables
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.service_watch import ServiceWatch
from rga.operation.alarms.supervision import ALARMS, SERVICE, Supervision
from rga.operation.alarms.twin_watch import Troubles, TwinWatch
from rga.operation.configuration import Configuration
from rga.operation.disk.forecast import DiskForecast, disk_forecast
from rga.operation.disk.room import DiskRoom
from rga.operation.inbox.packets import NEVER
from rga.operation.notices.fault_log import FaultLog
from rga.operation.notices.notify_settings import NotifySettings
from rga.operation.notices.outbox import Outbox
from rga.operation.notices.words import all_is_well
from rga.operation.readiness import ALIVE, tell_system
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock, microseconds, moment_of
from rga.operation.service_file import service_file
from rga.operation.sources.settings import MqttSource, source_name
from rga.operation.sources.source import DataSource, attempt
from rga.operation.workers import Workers

if TYPE_CHECKING:
    from rga.operation.telling.teller import Teller

#: how often rows are sealed [s]
SEAL = 0.1
#: how often it is looked for what is wrong, for notices to be sent, and for what is old [s]
WATCH, TELL, TIDY = 2.0, 1.0, 3600.0
#: how long the end of the service waits for a notice that is being sent [s]
LAST_NOTICE = 5.0
#: what a fault of making rows is kept under
ROWS = "rows"
#: what a fault of telling a broker is kept under, before the name of the source
TELLING = "telling"


class Service:
    """Everything that `rga serve` runs beside the pages.

    Args:
        configuration: of it.
        clock: None: that of this machine.
        said: takes lines of what keeps a source from going on, and of its end.

    Attributes:
        configuration: of it.
        twins: by name.
        alarms: what is wrong, and what people do about it.
        outbox: notices of alarms.
        faults: what keeps a source or the rows of a twin from going on, in words, by twin and
            source.
        room: on the disk of the twins.
        workers: play the twins.
    """

    def __init__(
        self,
        configuration: Configuration,
        clock: ServiceClock | None = None,
        said: Callable[[str], None] = lambda line: None,
    ) -> None:
        service, clock = configuration.service, clock or ServiceClock()
        self.configuration, self._clock = configuration, clock
        self.twins = {
            one.name: ServedTwin(one, service.data / one.name, clock) for one in configuration.twin
        }
        places = [one.directory for one in self.twins.values()]
        self.room = DiskRoom(service.data, configuration.alarms.disk)
        self.workers = Workers(places, service.repository, self.room.is_enough)
        self.faults: dict[tuple[str, str], str] = {}
        self._fault_log = FaultLog(said)
        self._sources: dict[tuple[str, str], DataSource] = {
            (twin.name, name): source
            for twin in self.twins.values()
            for name, source in twin.sources().items()
        }
        self._ending = Event()
        self._threads: list[Thread] = []
        self._telling: list[Thread] = []
        self._file = service_file(service.data, alarm_tables.metadata)
        self.outbox = Outbox(self._file, configuration.notify, service.address, clock)
        self.alarms = AlarmBook(self._file, configuration.alarms.delays, clock, self.outbox.add)
        self.supervision = self._supervision()
        self._tellers = self._brokers_told()

    def start(self) -> None:
        """Begin to take data in, to play the twins, and to tell of alarms.

        Raises:
            InputError: an address for notices cannot be used.
        """
        self._telling = [self._teller(one) for one in self.configuration.notify]
        self._threads = [
            Thread(target=self._seal, name=ROWS, daemon=True),
            self._again(WATCH, ALARMS, self.supervision.round),
            self._again(TIDY, "archive", self._tidy),
        ]
        for one in (*self._sources.values(), *self._tellers.values()):
            one.start()
        for thread in [*self._threads, *self._telling]:
            thread.start()
        self.workers.start()

    def stop(self) -> None:
        """Let go of everything: what was acknowledged is kept."""
        self._ending.set()
        for one in (*self._sources.values(), *self._tellers.values()):
            one.stop()
        for thread in self._threads:
            thread.join()
        for thread in self._telling:
            # What is being sent now is sent again when the service is there again.
            thread.join(LAST_NOTICE)
        self.workers.stop()
        self.supervision.close()
        for twin in self.twins.values():
            twin.close()
        self._file.close()

    def forecast(self, twin: str) -> DiskForecast:
        """How long the disk has room, as one twin sees it.

        Raises:
            InputError: its disk cannot be looked at, or the inbox of a twin not be read.
        """
        grown = {name: one.yearly_growth() for name, one in self.twins.items()}
        own = grown.pop(twin)
        return disk_forecast(self.room.free, self.room.free_share, own, grown.values())

    def _supervision(self) -> Supervision:
        """What looks at the twins and at the service."""
        settings, clock = self.configuration.alarms, self._clock
        service = self.configuration.service
        twins = [
            TwinWatch(
                self.twins[one.name], one, service.repository, settings.lag, self._file, clock
            )
            for one in self.configuration.twin
        ]
        watch = ServiceWatch(self.room, self.outbox.failing, clock)
        return Supervision(self.alarms, twins, watch, self._troubles, self.faults, clock)

    def _troubles(self) -> dict[str, Troubles]:
        """What keeps each twin from going on."""
        failed, faults = self.workers.failed, dict(self.faults)
        found = {}
        for name, twin in self.twins.items():
            sources = {one: self._fault(name, one) for one in twin.source_names}
            own = {one: fault for one, fault in sources.items() if fault is not None}
            found[name] = Troubles(own, faults.get((name, ROWS)), failed.get(twin.directory))
        return found

    def _brokers_told(self) -> dict[tuple[str, str], "Teller"]:
        """What tells brokers of twins, by twin and source."""
        return {
            (twin.name, source_name(one)): self._broker_told(twin.name, one)
            for twin in self.configuration.twin
            for one in twin.source
            if isinstance(one, MqttSource) and one.tell
        }

    def _broker_told(self, twin: str, source: MqttSource) -> "Teller":
        """What tells a broker of a twin."""
        from rga.operation.telling.teller import Teller

        repository = self.configuration.service.repository
        reading = TwinReading(twin, self.twins[twin].directory, repository)
        return Teller(source, reading, self.alarms, self._file, self._clock)

    def _teller(self, settings: NotifySettings) -> Thread:
        """A thread for a recipient: who is slow keeps no other from being told."""
        from rga.operation.notices.delivery import Delivery

        delivery = Delivery(settings, self.outbox, self._summary, self._clock)
        return self._again(TELL, settings.name, delivery.round)

    def _summary(self) -> str:
        """How things are, in a line."""
        sealed = {name: one.packets.sealed for name, one in self.twins.items()}
        rows = {name: None if at == NEVER else moment_of(at) for name, at in sealed.items()}
        return all_is_well(self.alarms.open(), rows)

    def _tidy(self) -> None:
        """Put away what is old."""
        now = microseconds(self._clock.now())
        for twin in self.twins.values():
            twin.archive.tidy(now, self.room.is_enough)

    def _seal(self) -> None:
        """Make rows, and tell what is wrong, until the end."""
        while not self._ending.wait(SEAL):
            # Whoever watches over the service begins it anew when rows are made no more.
            tell_system(ALIVE)
            for twin in self.twins.values():
                self._tell(twin.name, ROWS, attempt(partial(_seal, twin)))
                for name in twin.source_names:
                    fault = self._fault(twin.name, name)
                    self._tell(twin.name, name, fault or twin.clock_fault(name))
            for (name, source), teller in self._tellers.items():
                self._tell(name, f"{TELLING} {source}", teller.fault)
            self._fault_log.observe(dict(self.faults))

    def _fault(self, twin: str, source: str) -> str | None:
        """What keeps a source from going on; None: nothing, or others send to this service."""
        known = self._sources.get((twin, source))
        return None if known is None else known.fault

    def _again(self, every: float, what: str, does: Callable[[], None]) -> Thread:
        """Does something of the service again and again, whatever keeps it from being done."""

        def work() -> None:
            while not self._ending.wait(every):
                self._tell(SERVICE, what, attempt(does))

        return Thread(target=work, name=what, daemon=True)

    def _tell(self, twin: str, what: str, fault: str | None) -> None:
        if fault is None:
            self.faults.pop((twin, what), None)
        else:
            self.faults[twin, what] = fault


def _seal(twin: ServedTwin) -> None:
    twin.seal()
