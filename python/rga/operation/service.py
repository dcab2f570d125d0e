"""The service: sources, rows and workers, from the start to the end."""

import multiprocessing
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from threading import Event, Thread
from typing import Any

from rga.errors import InputError
from rga.jobs.worker import Kind, Worker
from rga.operation.alarms import tables as alarm_tables
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.service_watch import ServiceWatch
from rga.operation.alarms.supervision import ALARMS, SERVICE, Supervision
from rga.operation.alarms.twin_watch import Troubles, TwinWatch
from rga.operation.alarms.worker_failures import WorkerFailures
from rga.operation.configuration import (
    Configuration,
    FolderSource,
    HttpSource,
    MqttSource,
    source_name,
)
from rga.operation.inbox.numbers import Numbers
from rga.operation.inbox.packets import NEVER
from rga.operation.notices.outbox import Outbox
from rga.operation.notices.words import all_is_well
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock, moment_of
from rga.operation.service_file import service_file
from rga.operation.sources.folder import Folder

#: how often rows are sealed, and how long a worker rests where nothing is due [s]
SEAL, REST = 0.2, 0.2
#: how often it is looked for what is wrong, and for notices that are to be sent [s]
WATCH, TELL = 2.0, 1.0
#: how long the end of the service waits for a notice that is being sent [s]
LAST_NOTICE = 5.0
#: lines before the first row of a text file, where a mapping does not say it
HEAD_LINES = 1


class Service:
    """Everything that `rga serve` runs beside the pages.

    Args:
        configuration: of it.
        clock: None: that of this machine.

    Attributes:
        twins: by name.
        alarms: what is wrong, and what people do about it.
        outbox: notices of alarms.
        faults: what keeps a source or the rows of a twin from going on, in words, by twin and
            source.
    """

    def __init__(self, configuration: Configuration, clock: ServiceClock | None = None) -> None:
        service, clock = configuration.service, clock or ServiceClock()
        self._repository, self._data, self._clock = service.repository, service.data, clock
        self.twins = {
            one.name: ServedTwin(one, service.data / one.name, service.repository, clock)
            for one in configuration.twin
        }
        self.faults: dict[tuple[str, str], str] = {}
        self._configuration = configuration
        self._ending = Event()
        self._threads: list[Thread] = []
        self._brokers: dict[tuple[str, str], Any] = {}
        self._workers: list[multiprocessing.process.BaseProcess] = []
        self._telling: list[Thread] = []
        self._file = service_file(service.data, alarm_tables.metadata)
        self._failures = WorkerFailures(self._file)
        self.outbox = Outbox(self._file, configuration.notify, service.address, clock)
        self.alarms = AlarmBook(self._file, configuration.alarms.delays, clock, self.outbox.add)
        self.supervision = self._supervision()

    def start(self) -> None:
        """Begin to take data in, to play the twins, and to tell of alarms.

        Raises:
            InputError: an address for notices cannot be used.
        """
        self._begin_telling()
        watch = partial(self._again, WATCH, ALARMS, self.supervision.round)
        self._threads = [
            Thread(target=self._seal, name="rows", daemon=True),
            Thread(target=watch, name="alarms", daemon=True),
        ]
        for twin in self._configuration.twin:
            for source in twin.source:
                self._begin(self.twins[twin.name], source)
        for thread in self._threads:
            thread.start()
        spawn = multiprocessing.get_context("spawn")
        places = [one.directory for one in self.twins.values()]
        kinds: tuple[Kind, ...] = ("watch", "heavy")
        for kind in kinds:
            work = partial(_play, places, kind, self._repository, self._data)
            self._workers.append(spawn.Process(target=work, name=kind, daemon=True))
            self._workers[-1].start()

    def stop(self) -> None:
        """Let go of everything: what was acknowledged is kept."""
        self._ending.set()
        for broker in self._brokers.values():
            broker.stop()
        for thread in self._threads:
            thread.join()
        for thread in self._telling:
            # What is being sent now is sent again when the service is there again.
            thread.join(LAST_NOTICE)
        for worker in self._workers:
            worker.terminate()
            worker.join()
        self.supervision.close()
        for twin in self.twins.values():
            twin.close()
        self._file.close()

    def _supervision(self) -> Supervision:
        """What looks at the twins and at the service."""
        settings, clock = self._configuration.alarms, self._clock
        twins = [
            TwinWatch(self.twins[one.name], one, self._repository, settings.lag, self._file, clock)
            for one in self._configuration.twin
        ]
        service = ServiceWatch(
            self._data, settings.disk, self._ended_workers, self.outbox.failing, clock
        )
        return Supervision(self.alarms, twins, service, self._troubles, self.faults, clock)

    def _troubles(self) -> dict[str, Troubles]:
        """What keeps each twin from going on."""
        faults, failed = dict(self.faults), self._failures.now()
        faults |= {key: one.fault for key, one in self._brokers.items() if one.fault is not None}
        found = {}
        for name in self.twins:
            own = {what: words for (twin, what), words in faults.items() if twin == name}
            found[name] = Troubles(own, own.pop("rows", None), failed.get(name))
        return found

    def _ended_workers(self) -> list[str]:
        return [one.name for one in self._workers if not one.is_alive()]

    def _begin_telling(self) -> None:
        """A thread for each recipient: who is slow keeps no other from being told."""
        if self._configuration.notify:
            from rga.operation.notices.delivery import Delivery

            for one in self._configuration.notify:
                delivery = Delivery(one, self.outbox, self._summary, self._clock)
                tell = partial(self._again, TELL, one.name, delivery.round)
                self._telling.append(Thread(target=tell, name="notices", daemon=True))
            for thread in self._telling:
                thread.start()

    def _again(self, every: float, what: str, does: Callable[[], None]) -> None:
        """Do something of the service again and again, whatever keeps it from being done now."""
        while not self._ending.wait(every):
            try:
                does()
            except InputError as error:
                self.faults[SERVICE, what] = str(error)
            else:
                self.faults.pop((SERVICE, what), None)

    def _summary(self) -> str:
        """How things are, in a line."""
        sealed = {name: one.packets.sealed for name, one in self.twins.items()}
        rows = {name: None if at == NEVER else moment_of(at) for name, at in sealed.items()}
        return all_is_well(self.alarms.open(), rows)

    def _begin(self, twin: ServedTwin, source: HttpSource | MqttSource | FolderSource) -> None:
        name = source_name(source)
        if isinstance(source, FolderSource):
            folder = Folder(source.path, source.files, HEAD_LINES)
            look = partial(self._look, twin, name, folder, source.poll)
            self._threads.append(Thread(target=look, name=f"folder of {twin.name}", daemon=True))
        elif isinstance(source, MqttSource):
            from rga.operation.sources.mqtt import Broker

            keep = partial(_keep, twin, name)
            broker = Broker(source.url, source.topics, twin.name, name, source.credentials, keep)
            self._brokers[twin.name, name] = broker
            broker.start()

    def _seal(self) -> None:
        while not self._ending.wait(SEAL):
            for twin in self.twins.values():
                self._try(twin, "rows", twin.seal)

    def _look(self, twin: ServedTwin, source: str, folder: Folder, poll: float) -> None:
        while not self._ending.is_set():
            if folder.is_there:
                self._try(twin, source, partial(self._take, twin, source, folder))
            else:
                self.faults[twin.name, source] = "the folder is away"
            self._ending.wait(poll)

    def _take(self, twin: ServedTwin, source: str, folder: Folder) -> None:
        for piece in folder.pieces(twin.packets.cursor(source)):
            twin.receive(source, [(piece.where, piece.payload)], piece.cursor)
            if self._ending.is_set():
                return

    def _try(self, twin: ServedTwin, what: str, does: Any) -> None:
        """Do something that is done again soon, whatever keeps it from being done now."""
        try:
            does()
        except (InputError, OSError) as error:
            self.faults[twin.name, what] = str(error)
        else:
            self.faults.pop((twin.name, what), None)


def _keep(
    twin: ServedTwin, source: str, payloads: Sequence[tuple[str, bytes]]
) -> dict[str, Numbers]:
    twin.receive(source, payloads)
    return twin.numbers(source)


def _play(places: Sequence[Path], kind: Kind, repository: str | None, data: Path) -> None:
    """What a worker does until it is ended, or the service is gone."""
    worker = Worker(places, [kind], repository)
    told: dict[str, str] | None = None
    service = multiprocessing.parent_process()
    while service is None or service.is_alive():
        resting = not worker.round()
        failed = {place.name: words for place, words in worker.failed.items()}
        if failed != told:
            # Where that cannot be written, it is told after the next round.
            with suppress(InputError), service_file(data, alarm_tables.metadata) as file:
                WorkerFailures(file).tell(kind, failed)
                told = failed
        if resting:
            time.sleep(REST)
