"""The service: sources, rows and workers, from the start to the end."""

from collections.abc import Sequence
from functools import partial
from threading import Event, Thread
from typing import Any

from rga.errors import InputError
from rga.operation.configuration import (
    Configuration,
    FolderSource,
    HttpSource,
    MqttSource,
    source_name,
)
from rga.operation.inbox.numbers import Numbers
from rga.operation.served_twin import ServedTwin
from rga.operation.sources.folder import Folder
from rga.operation.workers import Workers

#: how often rows are sealed [s]
SEAL = 0.2
#: lines before the first row of a text file, where a mapping does not say it
HEAD_LINES = 1


class Service:
    """Everything that `rga serve` runs beside the pages.

    Args:
        configuration: of it.

    Attributes:
        configuration: of it.
        twins: by name.
        faults: what keeps a source or the rows of a twin from going on, in words, by twin and
            source.
        workers: play the twins.
    """

    def __init__(self, configuration: Configuration) -> None:
        service = configuration.service
        self.twins = {
            one.name: ServedTwin(one, service.data / one.name, service.repository)
            for one in configuration.twin
        }
        places = [one.directory for one in self.twins.values()]
        self.workers = Workers(places, service.repository)
        self.faults: dict[tuple[str, str], str] = {}
        self.configuration = configuration
        self._ending = Event()
        self._threads: list[Thread] = []
        self._brokers: list[Any] = []

    def start(self) -> None:
        """Begin to take data in and to play the twins."""
        self._threads = [Thread(target=self._seal, name="rows", daemon=True)]
        for twin in self.configuration.twin:
            for source in twin.source:
                self._begin(self.twins[twin.name], source)
        for thread in self._threads:
            thread.start()
        self.workers.start()

    def stop(self) -> None:
        """Let go of everything: what was acknowledged is kept."""
        self._ending.set()
        for broker in self._brokers:
            broker.stop()
        for thread in self._threads:
            thread.join()
        self.workers.stop()
        for twin in self.twins.values():
            twin.close()

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
            self._brokers.append(broker)
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
