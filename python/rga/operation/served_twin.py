"""One twin of a service: what its sources send becomes packets, rows, and steps of the twin."""

import time
from collections.abc import Sequence
from pathlib import Path
from threading import Lock
from typing import Any

from rga.errors import InputError
from rga.jobs.live import live
from rga.model import Model, load_model
from rga.operation.configuration import TwinSettings, source_name
from rga.operation.inbox.numbers import Numbers
from rga.operation.inbox.packets import Fate, Packets
from rga.operation.rows.samples import Reader
from rga.operation.rows.sealing import Sealing
from rga.operation.sources.arrivals import arrival_of
from rga.records.mapping import RecordMapping, read_mapping
from rga.settings_files import read_table, validated
from rga.twin.hardware.inbox import Inbox
from rga.twin.settings import Settings


class ServedTwin:
    """A twin with its inbox; what is received is on the disk when `receive` returns.

    Args:
        settings: of the twin.
        directory: of the twin, which is made.
        repository: URL of a PostgreSQL database, or None.

    Attributes:
        model: as it was given.
        sources: their names.
        inbox: rows and commands that wait for it.
        packets: that have come.

    Raises:
        InputError: its model, its settings or a mapping cannot be used.
    """

    def __init__(self, settings: TwinSettings, directory: Path, repository: str | None) -> None:
        self.name, self.directory = settings.name, directory
        self.model = model = load_model(settings.model)
        live(
            model,
            directory,
            settings=live_settings(settings.settings),
            name=settings.name,
            seed=settings.seed,
            repository=repository,
        ).close()
        self._sources = {source_name(one): one for one in settings.source}
        self.sources = tuple(self._sources)
        self._readers = {
            name: _reader(name, one.mapping, model) for name, one in self._sources.items()
        }
        self.inbox = Inbox(directory)
        grid = settings.rows.grid
        self.packets = Packets(self.inbox, grid, self._sources)
        self._sealing = Sealing(self.inbox, self.packets, model, self._readers, grid)
        self._patience = settings.rows.patience
        self._heard = dict.fromkeys(self._sources, time.monotonic())
        # Sources that were silent when rows were last made of all that had come.
        self._sealed_for: set[str] | None = None
        self._lock = Lock()

    @property
    def http_source(self) -> str | None:
        """Name of the source that sends to this service; None: there is none."""
        return next((name for name, one in self._sources.items() if one.kind == "http"), None)

    def receive(
        self, source: str, payloads: Sequence[tuple[str, bytes]], cursor: Any = None
    ) -> list[tuple[Fate, str | None]]:
        """Keep payloads, each with the place that it came from.

        Args:
            source: name of it.
            payloads: in their order.
            cursor: where the source reads on.

        Returns:
            What becomes of each, and why if it is refused.

        Raises:
            InputError: nothing of them is kept: the disk is full.
        """
        arrived, rule = time.time_ns() // 1000, self._sources[source].clock.rule
        reader = self._readers[source]
        arrivals = [
            arrival_of(payload, arrived, where, reader, rule) for where, payload in payloads
        ]
        fates = self.packets.receive(source, arrivals, cursor)
        self._heard[source] = time.monotonic()
        self._sealed_for = None
        return [(fate, one.refused) for fate, one in zip(fates, arrivals, strict=True)]

    def numbers(self, source: str) -> dict[str, Numbers]:
        """The numbers that have come of each stream of a source."""
        return self.packets.numbers(source)

    def seal(self) -> int:
        """Make rows of what is final; how many are new."""
        now = time.monotonic()
        silent = {name for name, since in self._heard.items() if now - since > self._patience}
        with self._lock:
            if silent == self._sealed_for:
                return 0
            self._sealed_for = silent
            try:
                return self._sealing.seal(silent)
            except BaseException:
                self._sealed_for = None
                raise

    def close(self) -> None:
        """Close the file of the inbox."""
        self.inbox.close()


def live_settings(path: Path) -> Settings:
    """Settings of a twin that is served: what a diagnosis names is proposed, unless they say so.

    Raises:
        InputError: the file cannot be read, or a setting is unknown or impossible.
    """
    content = {"adopt": "ask"} | read_table(path, "settings")
    return validated(Settings, content, str(path), "settings")


def _reader(source: str, path: Path | None, model: Model) -> Reader:
    mapping = RecordMapping() if path is None else read_mapping(path)
    if mapping.zero is not None or mapping.beside:
        raise InputError(
            "a source that goes on has no zero of its own and no files beside it",
            str(path),
            "leave out zero and beside, and name each logger a source",
        )
    return Reader(source, model, mapping)
