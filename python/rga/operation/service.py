"""The service: sources, rows and workers, from the start to the end."""

from functools import partial
from threading import Event, Thread

from rga.operation.configuration import Configuration
from rga.operation.served_twin import ServedTwin
from rga.operation.sources.source import DataSource, attempt
from rga.operation.workers import Workers

#: how often rows are sealed [s]
SEAL = 0.2


class Service:
    """Everything that `rga serve` runs beside the pages.

    Args:
        configuration: of it.

    Attributes:
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
        self._ending = Event()
        self._sealing = Thread(target=self._seal, name="rows", daemon=True)
        self._sources: dict[tuple[str, str], DataSource] = {
            (twin.name, name): source
            for twin in self.twins.values()
            for name, source in twin.sources().items()
        }

    def start(self) -> None:
        """Begin to take data in and to play the twins."""
        for source in self._sources.values():
            source.start()
        self._sealing.start()
        self.workers.start()

    def stop(self) -> None:
        """Let go of everything: what was acknowledged is kept."""
        self._ending.set()
        for source in self._sources.values():
            source.stop()
        if self._sealing.ident is not None:
            self._sealing.join()
        self.workers.stop()
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
