"""What the API and the pages see of a service."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial

from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.disk.forecast import DiskForecast
from rga.operation.reading.twin_now import TwinNow
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.served_twin import ServedTwin
from rga.operation.service import Service
from rga.twin.commands.command import AnyCommand, read_command
from rga.twin.restore import standing_of


@dataclass(frozen=True)
class Feed:
    """How the rows of a twin come, by the time at which things arrive and not by what they say.

    Attributes:
        lag: rows that are sealed, and that the twin has not played yet.
        silence: how long none of its sources has sent anything [s]; None: one is heard of.
        backlog: how old what they send is [s]; 0: no older than it may be.
    """

    lag: int = 0
    silence: float | None = None
    backlog: float = 0.0


@dataclass(frozen=True)
class SeenTwin:
    """A twin as its pages see it.

    Attributes:
        name: of the twin.
        served: what its sources send to.
        reading: what it says of itself.
        faults: what keeps its sources or its rows from going on, in words, by what it concerns.
        alarms: of the service, of this twin among others.
        forecast: how long the disk of the service has room.
    """

    name: str
    served: ServedTwin
    reading: TwinReading
    faults: Mapping[str, str]
    alarms: AlarmBook
    forecast: Callable[[], DiskForecast]

    def waiting(self) -> list[AnyCommand]:
        """What people have asked for, and nothing has carried out yet."""
        view = self.reading.view()
        done = 0 if view is None else standing_of(view).commanded
        return [read_command(text) for _, text in self.served.inbox.commands(done)]

    def lag(self, now: TwinNow | None) -> int:
        """Rows that are sealed, and that the twin has not played yet."""
        return self.served.inbox.rows - (0 if now is None else now.rows)

    def feed(self, now: TwinNow | None) -> Feed:
        """How its rows come."""
        names = self.served.source_names
        is_silent = len(self.served.silent) == len(names)
        silence = min(map(self.served.silence, names)) if is_silent else None
        return Feed(self.lag(now), silence, self.served.backlog)

    @property
    def is_out_of_sync(self) -> bool:
        """Whether its alarm is open that says so: raised and not cleared, whoever knows of it."""
        return any(
            one.twin == self.name and one.kind == "gap" and one.is_active
            for one in self.alarms.open()
        )


class Surroundings:
    """The twins of a service, opened for reading once.

    Args:
        service: that runs.

    Attributes:
        alarms: of it.
    """

    def __init__(self, service: Service) -> None:
        self._service, self.alarms = service, service.alarms
        settings = service.configuration
        self._readings = {
            one.name: TwinReading(
                one.name, service.twins[one.name].directory, settings.service.repository
            )
            for one in settings.twin
        }

    @property
    def names(self) -> tuple[str, ...]:
        """Of the twins."""
        return tuple(self._readings)

    def twin(self, name: str) -> SeenTwin:
        """A twin.

        Raises:
            KeyError: there is none of this name.
        """
        faults = {what: words for (of, what), words in self._service.faults.items() if of == name}
        return SeenTwin(
            name,
            self._service.twins[name],
            self._readings[name],
            faults,
            self.alarms,
            partial(self._service.forecast, name),
        )

    @staticmethod
    def now() -> datetime:
        """The time at which a page is drawn."""
        return datetime.now(UTC)
