"""A book of alarms that tests write in by hand."""

from pathlib import Path

from rga.operation.alarms import tables
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.condition import AlarmKind, Condition, ConditionKey, Observation
from rga.operation.alarms.operator_alarm import AlarmTransition, OperatorAlarm
from rga.operation.service_file import service_file
from served.service_times import NOON, SetClock

DELAYS: dict[AlarmKind, tuple[float, float]] = {
    "gap": (0, 0), "quality": (60, 120), "source": (0, 60), "service": (30, 30), "proposal": (0, 0),
}  # fmt: skip
JUDGED = frozenset(DELAYS)
GAP = ConditionKey("east", "gap", "alarm", "twin")
SILENT = ConditionKey("east", "quality", "silent", "D1")


def wrong(key: ConditionKey, size: int = 0) -> Condition:
    return Condition(key, f"{key.subject} is {key.cause}", NOON, ("D1",), size)


class Desk:
    """A book of alarms, what it tells, and a clock that is set by hand."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.clock = folder, SetClock()
        self.told: list[tuple[int, str]] = []
        self.start()

    def start(self) -> None:
        self.file = service_file(self.folder, tables.metadata)
        self.book = AlarmBook(self.file, DELAYS, self.clock, self._tell)

    def restart(self) -> None:
        self.file.close()
        self.start()

    def see(self, *conditions: Condition, after: float = 1.0, **more: object) -> None:
        self.clock.pass_by(after)
        observed: dict[str, object] = {"judged": JUDGED} | more
        self.book.observe("east", Observation(conditions, **observed))  # type: ignore[arg-type]

    def _tell(self, _: object, alarm: OperatorAlarm, transition: AlarmTransition) -> None:
        self.told.append((alarm.id, transition.change))

    @property
    def states(self) -> list[tuple[int, str]]:
        return [(one.id, one.state) for one in self.book.open()]
