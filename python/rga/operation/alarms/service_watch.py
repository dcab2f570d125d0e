"""What can be wrong with the service itself: its disk, its notices."""

from collections.abc import Callable, Mapping

from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.disk.room import DiskRoom
from rga.operation.service_clock import ServiceClock

#: what a disk with little room keeps from going on
WAITS = "calibrations, diagnoses and the archive of packets wait"


class ServiceWatch:
    """Looks at the service.

    Args:
        room: on the disk of the twins.
        undelivered: why notices do not arrive, by whom they are for.
        clock: of the service.
    """

    def __init__(
        self,
        room: DiskRoom,
        undelivered: Callable[[], Mapping[str, str]],
        clock: ServiceClock,
    ) -> None:
        self._room, self._undelivered, self._clock = room, undelivered, clock

    def look(self, restarted: bool) -> Observation:
        """What there is to see now.

        Args:
            restarted: the service is up for too short to tell whether all is well again.

        Raises:
            InputError: the file of the service cannot be read, or its disk not be looked at.
        """
        found = []
        if not self._room.is_enough():
            words = f"less than {self._room.least:.0%} of the disk is free: {WAITS} for room"
            found.append(self._wrong("disk", "data", words))
        found += [
            self._wrong("undelivered", name, f"notices of {name} do not arrive: {why}")
            for name, why in self._undelivered().items()
        ]
        return Observation(tuple(found), frozenset() if restarted else frozenset({"service"}))

    def _wrong(self, cause: str, subject: str, words: str) -> Condition:
        return Condition(ConditionKey(None, "service", cause, subject), words, self._clock.now())
