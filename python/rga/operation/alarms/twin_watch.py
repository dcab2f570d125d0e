"""All that is looked at of one twin."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial

from sqlalchemy import Connection, delete, insert, select

from rga.errors import InputError
from rga.operation.alarms import tables
from rga.operation.alarms.account_watch import AccountWatch
from rga.operation.alarms.condition import AlarmKind, Condition, ConditionKey, Observation
from rga.operation.alarms.repository_watch import RepositoryWatch, RunPlace, SeenRun
from rga.operation.alarms.sensor_quality import SensorQuality
from rga.operation.alarms.source_watch import SourceWatch
from rga.operation.configuration import TwinSettings
from rga.operation.inbox.kept_cells import cells_after
from rga.operation.inbox.packets import NEVER
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock
from rga.operation.sources.clock import in_words
from rga.operation.sources.settings import source_name
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of
from rga.twin.settings import Settings

#: rows that are looked at at a time
MOST_CELLS = 256
#: rows that are looked at where nothing is known of the sensors
MOST_PAST = 10_000
#: rows after which it is kept how the sensors are; those behind are looked at again after a restart
KEPT_EVERY = 64
#: classes of alarms of which nobody knows right after a start whether all is well again
SLOW: frozenset[AlarmKind] = frozenset({"quality", "source", "service"})
#: what needs time to be told from what has not begun: that something does not come, or lags
ABSENT = frozenset({"silent", "down", "missing", "lag"})


@dataclass(frozen=True)
class Troubles:
    """What the service knows of a twin that does not go on.

    Attributes:
        sources: what keeps a source from going on, in words.
        rows: what keeps rows from being made; None: nothing.
        playing: why it cannot be played; None: it can.
    """

    sources: Mapping[str, str]
    rows: str | None = None
    playing: str | None = None


class TwinWatch:
    """Looks at a twin: what it says, its sensors, its sources, and whether it goes on.

    Args:
        twin: that is served.
        settings: of it.
        repository: URL of a PostgreSQL database, or None.
        lag: by which it may be behind its rows [s].
        file: of the service, with the tables of alarms.
        clock: of the service.

    Raises:
        InputError: its inbox or the file of the service cannot be read.
    """

    def __init__(
        self,
        twin: ServedTwin,
        settings: TwinSettings,
        repository: str | None,
        lag: float,
        file: TableFile,
        clock: ServiceClock,
    ) -> None:
        self.name, self.patience = twin.name, settings.rows.patience
        self._twin, self._rows, self._lag, self._clock = twin, settings.rows, lag, clock
        addressee = twin.inbox.addressee
        assert addressee is not None  # a twin that is served is named
        chosen = Settings.model_validate_json(addressee.settings)
        self._packet = chosen.packet or 1
        self._stored = _stored(file, twin.name)
        self._next: _Watched | None = None
        place = None if self._stored is None else self._stored.place
        self._reading = TwinReading(twin.name, twin.directory, repository)
        self._run = RepositoryWatch(self._reading, chosen, self._rows.every, twin.model, place)
        self._quality: SensorQuality | None = None
        self._account = AccountWatch(twin, clock)
        names = [source_name(one) for one in settings.source]
        self._sources = SourceWatch(twin, names, self.patience, self._rows.lateness, clock)

    def close(self) -> None:
        """Close the connections to the repository."""
        self._reading.close()

    def look(self, troubles: Troubles, restarted: bool) -> Observation:
        """What there is to see now.

        Args:
            troubles: that the service knows of.
            restarted: the service is up for too short to tell what is silent or well again; what
                is wrong otherwise is seen all the same.
        """
        unknown: set[AlarmKind] = set()
        found, seen = self._in_service(troubles), None
        try:
            seen = self._run.look()
            found += [*seen.conditions, *self._behind(seen)]
        except InputError as error:
            unknown |= {"gap", "proposal"}
            found.append(self._trouble("repository", f"the repository: {error}"))
        try:
            found += [*self._of_sensors(), *self._sources.look(troubles.sources)]
            found += self._account.look()
        except InputError as error:
            unknown |= {"quality", "source"}
            found.append(self._trouble("inbox", f"the inbox: {error}"))
        found = [one for one in found if one.key.kind not in unknown]
        judged = {"gap", "proposal", *SLOW} - unknown
        if restarted:
            found, judged = [one for one in found if one.key.cause not in ABSENT], judged - SLOW
        return Observation(
            tuple(found),
            frozenset(judged),
            () if seen is None else seen.occurred,
            {} if seen is None else seen.endings,
            None if seen is None else self._to_keep(seen),
        )

    def kept(self) -> None:
        """The alarms of what was seen last are kept."""
        if self._next is not None:
            self._stored = self._next
        self._run.kept()

    def _to_keep(self, seen: SeenRun) -> Callable[[Connection], None] | None:
        """Writes up to where it was looked, where it could not be told after a restart."""
        quality, before = self._quality, self._stored
        cell = NEVER if quality is None else quality.last
        known = before is not None and before.run == seen.place.run and not seen.occurred
        near = before is not None and cell - before.cell < KEPT_EVERY * self._rows.grid.every
        self._next = None
        if known and near:
            return None
        sensors = "" if quality is None else quality.to_json()
        self._next = _Watched(seen.place.run, seen.place.step, cell, sensors)
        return partial(self._next.write, self.name)

    def _of_sensors(self) -> list[Condition]:
        if self._quality is None:
            station = self._twin.inbox.station
            if station is None:
                return []
            names = (*station.channels, *station.measured)
            state = None if self._stored is None else self._stored.sensors
            self._quality = SensorQuality(
                self.name, names, self._twin.model, self._rows.every, self.patience, state or None
            )
            past = self._twin.packets.sealed - MOST_PAST * self._rows.grid.every
            self._quality.last = max(self._quality.last, past)
        while cells := cells_after(self._twin.inbox, self._quality.last, MOST_CELLS):
            for cell in cells:
                self._quality.take(cell)
        return self._quality.conditions()

    def _behind(self, seen: SeenRun) -> list[Condition]:
        # A packet that is not full waits.
        waiting = self._twin.inbox.rows - seen.rows - (self._packet - 1)
        if waiting * self._rows.every <= self._lag:
            return []
        words = f"the twin is behind its rows by more than {in_words(self._lag)}"
        return [self._trouble("lag", words)]

    def _in_service(self, troubles: Troubles) -> list[Condition]:
        found = []
        if troubles.rows is not None:
            found.append(self._trouble("rows", f"no rows are made: {troubles.rows}"))
        if troubles.playing is not None:
            found.append(self._trouble("parked", f"the twin is not played: {troubles.playing}"))
        return found

    def _trouble(self, cause: str, words: str) -> Condition:
        key = ConditionKey(self.name, "service", cause, "twin")
        return Condition(key, words, self._clock.now())


@dataclass(frozen=True)
class _Watched:
    """Up to where a twin was looked at, as it is kept.

    Attributes:
        run, step: place in its run.
        cell: begin of the last row [µs since 1970].
        sensors: how they were then, as `SensorQuality` writes it; empty: nothing is known.
    """

    run: str
    step: int
    cell: int
    sensors: str

    @property
    def place(self) -> RunPlace:
        """Where the run was looked at."""
        return RunPlace(self.run, self.step)

    def write(self, twin: str, connection: Connection) -> None:
        """Keep it, in place of what was known of the twin."""
        connection.execute(delete(tables.watched).where(tables.watched.c.twin == twin))
        entry = with_checksum(twin=twin, **asdict(self))
        connection.execute(insert(tables.watched).values(**entry))


def _stored(file: TableFile, twin: str) -> _Watched | None:
    """Up to where a twin was looked at before; None: never."""
    chosen = select(tables.watched).where(tables.watched.c.twin == twin)
    with file.reading() as connection:
        entry = connection.execute(chosen).one_or_none()
        if entry is None:
            return None
        values = values_of(tables.watched, entry)
    values.pop("twin")
    return _Watched(**values)
