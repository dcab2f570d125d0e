"""The service: sources, rows and workers, from the start to the end."""

import multiprocessing
import time
from collections.abc import Collection, Sequence
from functools import partial
from pathlib import Path
from threading import Event, Thread

from rga.jobs.worker import Kind, Worker
from rga.operation.configuration import Configuration
from rga.operation.served_twin import ServedTwin
from rga.operation.sources.source import DataSource, attempt

#: how often rows are sealed, and how long a worker rests where nothing is due [s]
SEAL, REST = 0.2, 0.2


class Service:
    """Everything that `rga serve` runs beside the pages.

    Args:
        configuration: of it.

    Attributes:
        twins: by name.
        faults: what keeps a source or the rows of a twin from going on, in words, by twin and
            source.
    """

    def __init__(self, configuration: Configuration) -> None:
        service = configuration.service
        self._repository, self._data = service.repository, service.data
        self.twins = {
            one.name: ServedTwin(one, service.data / one.name, service.repository)
            for one in configuration.twin
        }
        self.faults: dict[tuple[str, str], str] = {}
        self._ending = Event()
        self._sealing = Thread(target=self._seal, name="rows", daemon=True)
        self._sources: dict[tuple[str, str], DataSource] = {
            (twin.name, name): source
            for twin in self.twins.values()
            for name, source in twin.sources().items()
        }
        self._workers: list[multiprocessing.process.BaseProcess] = []

    def start(self) -> None:
        """Begin to take data in and to play the twins."""
        for source in self._sources.values():
            source.start()
        self._sealing.start()
        spawn = multiprocessing.get_context("spawn")
        places = [one.directory for one in self.twins.values()]
        for kind in ("watch", "heavy"):
            work = partial(_play, places, [kind], self._repository)
            self._workers.append(spawn.Process(target=work, name=kind, daemon=True))
            self._workers[-1].start()

    def stop(self) -> None:
        """Let go of everything: what was acknowledged is kept."""
        self._ending.set()
        for source in self._sources.values():
            source.stop()
        if self._sealing.ident is not None:
            self._sealing.join()
        for worker in self._workers:
            worker.terminate()
            worker.join()
        for twin in self.twins.values():
            twin.close()

    def _seal(self) -> None:
        """Make rows, and tell what is wrong, until the end."""
        while not self._ending.wait(SEAL):
            for twin in self.twins.values():
                self._tell(twin.name, "rows", attempt(partial(_seal, twin)))
                for name in twin.source_names:
                    source = self._sources.get((twin.name, name))
                    fault = None if source is None else source.fault
                    self._tell(twin.name, name, fault or twin.clock_fault(name))

    def _tell(self, twin: str, what: str, fault: str | None) -> None:
        if fault is None:
            self.faults.pop((twin, what), None)
        else:
            self.faults[twin, what] = fault


def _seal(twin: ServedTwin) -> None:
    twin.seal()


def _play(places: Sequence[Path], kinds: Collection[Kind], repository: str | None) -> None:
    """What a worker does until it is ended, or the service is gone."""
    worker = Worker(places, kinds, repository)
    service = multiprocessing.parent_process()
    while service is None or service.is_alive():
        if not worker.round():
            time.sleep(REST)
