"""What can be wrong with the service itself: its disk, its notices."""

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path

from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.service_clock import ServiceClock


class ServiceWatch:
    """Looks at the service.

    Args:
        data: folder of the twins.
        disk: share of their disk below which there is too little room.
        undelivered: why notices do not arrive, by whom they are for.
        clock: of the service.
    """

    def __init__(
        self,
        data: Path,
        disk: float,
        undelivered: Callable[[], Mapping[str, str]],
        clock: ServiceClock,
    ) -> None:
        self._data, self._disk = data, disk
        self._undelivered, self._clock = undelivered, clock

    def look(self, restarted: bool) -> Observation:
        """What there is to see now.

        Args:
            restarted: the service is up for too short to tell.

        Raises:
            InputError: the file of the service cannot be read.
            OSError: its disk cannot be looked at.
        """
        if restarted:
            return Observation((), frozenset())
        found = []
        room = shutil.disk_usage(self._data)
        if room.free < self._disk * room.total:
            found.append(
                self._wrong("disk", "data", f"less than {self._disk:.0%} of the disk is free")
            )
        found += [
            self._wrong("undelivered", name, f"notices of {name} do not arrive: {why}")
            for name, why in self._undelivered().items()
        ]
        return Observation(tuple(found), frozenset({"service"}))

    def _wrong(self, cause: str, subject: str, words: str) -> Condition:
        return Condition(ConditionKey(None, "service", cause, subject), words, self._clock.now())
