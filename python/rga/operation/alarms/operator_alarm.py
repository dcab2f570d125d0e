"""The life of an alarm, as ISA-18.2 has it: raised, acknowledged, shelved, cleared."""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import Literal, Self

from pydantic import computed_field
from pydantic import dataclasses as told

from rga.errors import InputError
from rga.operation.alarms.condition import AlarmKind, Condition, ConditionKey
from rga.operation.service_clock import in_minutes

#: what changes in the life of an alarm
Change = Literal["raised", "renewed", "cleared", "acknowledged", "shelved", "unshelved"]
#: where it stands: `cleared` is back to normal while nobody has acknowledged it
AlarmState = Literal["raised", "acknowledged", "shelved", "cleared", "closed"]
#: an alarm that nobody hears of for longer is one that nobody wants: mend it, or its cause
LONGEST_SHELF = timedelta(days=30)


@told.dataclass(frozen=True)
class OperatorAlarm:
    """An alarm, from when it is raised until it is cleared and acknowledged.

    Attributes:
        id: number of it.
        twin: None: it is of the service itself.
        kind: class of it.
        cause: what is wrong, in a word.
        subject: what it is wrong with.
        words: what is wrong, in a sentence.
        sensors: that show it.
        size: of what is wrong, such as packets that are missing; 0: it has none.
        since: when it began to be wrong (UTC).
        raised_at: when the alarm was raised, the last time if more than once (UTC).
        cleared_at: when it was well again; None: it is not.
        acknowledged_at, acknowledged_by: when and by whom; None: it is not.
        shelved_until, shelved_by: until when nothing is told of it, and who wants that; None: it
            is not shelved.
        state: where it stands.
    """

    id: int
    twin: str | None
    kind: AlarmKind
    cause: str
    subject: str
    words: str
    sensors: tuple[str, ...]
    size: int
    since: datetime
    raised_at: datetime
    cleared_at: datetime | None = None
    acknowledged_at: datetime | None = None
    acknowledged_by: str | None = None
    shelved_until: datetime | None = None
    shelved_by: str | None = None

    @classmethod
    def begun(cls, id: int, condition: Condition, now: datetime) -> Self:
        """The alarm that a condition raises for the first time."""
        return cls(
            id,
            *condition.key,
            words=condition.words,
            sensors=condition.sensors,
            size=condition.size,
            since=condition.since,
            raised_at=now,
        )

    @property
    def key(self) -> ConditionKey:
        """The condition that it is about."""
        return ConditionKey(self.twin, self.kind, self.cause, self.subject)

    @property
    def is_active(self) -> bool:
        """Whether it is still wrong."""
        return self.cleared_at is None

    @property
    def is_shelved(self) -> bool:
        """Whether nobody wants to hear of it for now."""
        return self.shelved_until is not None

    @computed_field  # type: ignore[prop-decorator]
    @property
    def state(self) -> AlarmState:
        if self.is_shelved:
            return "shelved"
        if self.is_active:
            return "raised" if self.acknowledged_at is None else "acknowledged"
        return "cleared" if self.acknowledged_at is None else "closed"

    def raised_again(self, condition: Condition, now: datetime) -> Self:
        """The same where it is wrong again, or has become worse: it is to be acknowledged anew.

        What has become worse has begun when it did, and shows at all sensors at which it has.
        """
        before = self.sensors if self.is_active else ()
        return replace(
            self,
            words=condition.words,
            sensors=tuple(dict.fromkeys((*before, *condition.sensors))),
            size=condition.size,
            since=self.since if self.is_active else condition.since,
            raised_at=now,
            cleared_at=None,
            acknowledged_at=None,
            acknowledged_by=None,
        )

    def renewed(self, words: str) -> Self:
        """The same where other words say what is wrong now, or what came of it."""
        return replace(self, words=words)

    def decided(self, who: str, now: datetime) -> Self:
        """The same where somebody has dealt with what it is about: it needs no shelf any more."""
        known = self
        if self.acknowledged_at is None:
            known = replace(self, acknowledged_at=now, acknowledged_by=who)
        return replace(known, shelved_until=None, shelved_by=None)

    def cleared(self, now: datetime) -> Self:
        """The same where it is well again."""
        return replace(self, cleared_at=now)

    def acknowledged(self, who: str, now: datetime) -> Self:
        """The same where somebody has seen it.

        Raises:
            InputError: it is acknowledged already, or shelved.
        """
        if self.is_shelved:
            raise self._refused(f"is shelved by {self.shelved_by}", "unshelve it first")
        if self.acknowledged_at is not None:
            by = f"was acknowledged by {self.acknowledged_by} at {in_minutes(self.acknowledged_at)}"
            raise self._refused(by, "nothing is left to do")
        return replace(self, acknowledged_at=now, acknowledged_by=who)

    def shelved(self, until: datetime, who: str, now: datetime) -> Self:
        """The same where nobody wants to hear of it until some time.

        Raises:
            InputError: the time is none, has passed or is too far away, or the alarm is closed.
        """
        if self.state == "closed":
            raise self._refused("is closed", "shelve it when it is raised again")
        if until.tzinfo is None:
            raise self._refused("cannot be shelved: the time has no zone", "write it with Z")
        if not now < until <= now + LONGEST_SHELF:
            raise self._refused(
                f"cannot be shelved until {in_minutes(until)}",
                f"a shelf ends within {LONGEST_SHELF.days} days from now",
            )
        return replace(self, shelved_until=until, shelved_by=who)

    def unshelved(self) -> Self:
        """The same as it comes back: nobody has acknowledged it.

        Raises:
            InputError: it is not shelved.
        """
        if not self.is_shelved:
            raise self._refused("is not shelved", "nothing is left to do")
        return replace(
            self,
            shelved_until=None,
            shelved_by=None,
            acknowledged_at=None,
            acknowledged_by=None,
        )

    def _refused(self, what: str, remedy: str) -> InputError:
        return InputError(f"alarm {self.id} {what}", "alarms", remedy)


@dataclass(frozen=True)
class AlarmTransition:
    """A change in the life of an alarm.

    Attributes:
        number: of it: numbers rise.
        alarm: number of the alarm.
        change: what it was.
        at: when (UTC).
        who: None: nobody, it came about.
        why: as they gave it.
        words: of the alarm at that time.
    """

    number: int
    alarm: int
    change: Change
    at: datetime
    who: str | None
    why: str
    words: str
