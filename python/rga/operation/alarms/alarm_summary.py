"""An alarm as programs are told of it, by the API and by brokers."""

from dataclasses import asdict, dataclass
from datetime import datetime
from typing import Self

from rga.operation.alarms.condition import AlarmKind
from rga.operation.alarms.operator_alarm import AlarmState, OperatorAlarm


@dataclass(frozen=True)
class AlarmSummary:
    """An alarm.

    Attributes:
        id: number of it.
        state: where it stands.
        twin: None: it is of the service itself.
        kind, cause, subject: class of it, what is wrong in a word, and with what.
        words: what is wrong, in a sentence.
        sensors: that show it.
        size: of what is wrong, such as packets that are missing; 0: it has none.
        since: when it began to be wrong.
        raised_at, cleared_at: when the alarm was raised, and when all was well again.
        acknowledged_at, acknowledged_by: when and by whom.
        shelved_until, shelved_by: until when nothing is told of it, and who wants that.
    """

    id: int
    state: AlarmState
    twin: str | None
    kind: AlarmKind
    cause: str
    subject: str
    words: str
    sensors: tuple[str, ...]
    size: int
    since: datetime
    raised_at: datetime
    cleared_at: datetime | None
    acknowledged_at: datetime | None
    acknowledged_by: str | None
    shelved_until: datetime | None
    shelved_by: str | None

    @classmethod
    def of(cls, alarm: OperatorAlarm) -> Self:
        """That of an alarm as it stands."""
        return cls(state=alarm.state, **asdict(alarm))
