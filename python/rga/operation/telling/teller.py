"""Tells a broker of a twin as it goes on."""

from threading import Event

from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.service_clock import ServiceClock
from rga.operation.sources.settings import MqttSource, source_name
from rga.operation.sources.source import Polling
from rga.operation.telling.publisher import Publisher
from rga.operation.telling.told_place import NO_RUN, ToldPlace, ToldPlaces
from rga.operation.telling.twin_messages import TwinMessage, TwinMessages
from rga.twin.repository.table_file import TableFile

#: how often is looked for what is new, and where a twin stands is told at the least [s]
LOOK, ANEW = 1.0, 60.0


class Teller:
    """Tells a broker where a twin stands, and all that happens to it, at least once.

    What has happened is told behind what was told before, also before a restart. Where the broker
    was told nothing yet, what lies in the past is not told.

    Args:
        settings: of the broker.
        reading: of the twin.
        alarms: of the service.
        file: of the service.
        clock: of the service.

    Raises:
        InputError: the credentials cannot be read, or the file cannot be written.
    """

    def __init__(
        self,
        settings: MqttSource,
        reading: TwinReading,
        alarms: AlarmBook,
        file: TableFile,
        clock: ServiceClock,
    ) -> None:
        source = source_name(settings)
        self._reading, self._clock = reading, clock
        self._messages = TwinMessages(reading, alarms, clock)
        self._places = ToldPlaces(file, reading.name, source)
        self._publisher = Publisher(settings.url, reading.name, source, settings.credentials)
        self._polling = Polling(f"teller of {reading.name}", self._look, LOOK)
        self._told: ToldPlace | None = None
        self._connections = 0
        self._stated = 0.0

    @property
    def fault(self) -> str | None:
        """What keeps it from telling, in words; None: nothing."""
        return self._polling.fault

    def start(self) -> None:
        """Begin to tell; it returns at once."""
        self._publisher.start()
        self._polling.start()

    def stop(self) -> None:
        """Tell no more: what was not told is told when it is there again."""
        self._polling.stop()
        self._publisher.stop()
        self._reading.close()

    def _look(self, ending: Event) -> None:
        """Tell what is new.

        Raises:
            InputError: the broker is away, or the twin or the file of the service cannot be read.
        """
        self._publisher.check()
        connections, now = self._publisher.connections, self._clock.monotonic()
        told = self._told or self._places.last()
        found = self._messages.standing()
        said, place = list[TwinMessage](), found.place
        is_new, stands = connections != self._connections, now - self._stated >= ANEW
        if told is not None and told.run in (place.run, NO_RUN):
            said, place = self._messages.since(found, told)
            stands = stands or told.step != place.step
        else:
            is_new = True
        if is_new:
            said += self._messages.every_state(found)
        if is_new or stands:
            said += self._messages.state(found)
        if said and not self._publisher.publish(said, ending):
            return
        if place != told:
            self._places.keep(place)
        self._told, self._connections = place, connections
        if is_new or stands:
            self._stated = now
