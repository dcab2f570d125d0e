"""The book of alarms: what people see of them, and what they do about them."""

from collections.abc import Callable, Collection, Mapping
from datetime import datetime
from textwrap import shorten
from threading import RLock

from sqlalchemy import Connection

from rga.errors import InputError
from rga.operation.alarms import alarm_store as store
from rga.operation.alarms.condition import (
    AlarmKind,
    Condition,
    ConditionKey,
    Ending,
    Observation,
)
from rga.operation.alarms.delays import Delays, News
from rga.operation.alarms.operator_alarm import AlarmTransition, Change, OperatorAlarm
from rga.operation.service_clock import ServiceClock
from rga.twin.repository.table_file import TableFile

#: writes in the transaction of a transition what is to be told of it
Tell = Callable[[Connection, OperatorAlarm, AlarmTransition], None]
#: letters of a name and of a reason that somebody gives
MOST_LETTERS = 1000
#: more than there ever are
MOST_ALARMS = 2**60


class AlarmBook:
    """The alarms of a service.

    An alarm is open from when it is raised until it is cleared and acknowledged, and longer where
    it is shelved. What is raised again meanwhile is the same alarm, to be acknowledged anew.
    Somebody who made an end of what it is about has acknowledged it by that.

    Args:
        file: of the service, with the tables of alarms.
        delays: of each class, how long something is wrong before an alarm is raised, and well
            before it is cleared [s].
        clock: of the service.
        tell: writes notices; None: nobody is told.

    Example: `service.alarms.acknowledge(3, "Ada", "the bearing is being greased")`.
    """

    def __init__(
        self,
        file: TableFile,
        delays: Mapping[AlarmKind, tuple[float, float]],
        clock: ServiceClock,
        tell: Tell | None = None,
    ) -> None:
        self._file, self._delays, self._clock, self._tell = file, delays, clock, tell
        self._waiting = Delays()
        self._lock = RLock()

    def open(self) -> tuple[OperatorAlarm, ...]:
        """The alarms that are not closed, the oldest first."""
        with self._file.reading() as connection:
            return tuple(store.open_alarms(connection))

    def all(self, limit: int) -> tuple[OperatorAlarm, ...]:
        """The last so many alarms, open or closed, the newest first."""
        with self._file.reading() as connection:
            return tuple(store.newest_alarms(connection, limit))

    def of(self, id: int) -> OperatorAlarm:
        """The alarm of a number.

        Raises:
            InputError: there is none.
        """
        with self._file.reading() as connection:
            return _there(connection, id)

    def life(self, id: int) -> tuple[AlarmTransition, ...]:
        """All that has become of an alarm, who did it and why."""
        with self._file.reading() as connection:
            return tuple(store.transitions_of(connection, _there(connection, id).id))

    def transitions(self, after: int, limit: int) -> tuple[AlarmTransition, ...]:
        """Transitions of all alarms behind a number, in their order, at most so many.

        Whoever follows them asks for those behind the last that was seen.
        """
        with self._file.reading() as connection:
            return tuple(store.transitions_after(connection, after, limit))

    def last(self) -> int:
        """Number of the newest transition; 0: there is none."""
        with self._file.reading() as connection:
            return store.last_transition(connection)

    def acknowledge(self, id: int, who: str, why: str = "") -> OperatorAlarm:
        """Somebody has seen an alarm.

        Raises:
            InputError: there is none of this number, it is acknowledged already or shelved, or
                nobody is named.
        """
        return self._done(
            id, "acknowledged", who, why, lambda alarm, now: alarm.acknowledged(who, now)
        )

    def shelve(self, id: int, until: datetime, who: str, why: str = "") -> OperatorAlarm:
        """Somebody wants to hear nothing of an alarm until some time.

        Raises:
            InputError: there is none of this number, it is closed, the time cannot be used, or
                nobody is named.
        """
        return self._done(
            id, "shelved", who, why, lambda alarm, now: alarm.shelved(until, who, now)
        )

    def unshelve(self, id: int, who: str, why: str = "") -> OperatorAlarm:
        """Somebody wants to hear of an alarm again: it comes back unacknowledged.

        Raises:
            InputError: there is none of this number, it is not shelved, or nobody is named.
        """
        return self._done(id, "unshelved", who, why, lambda alarm, _: alarm.unshelved())

    def observe(self, twin: str | None, seen: Observation) -> None:
        """Raise and clear alarms, by what is seen of a twin or of the service (None).

        Raises:
            InputError: nothing can be written: it is to be observed again.
        """
        with self._lock:
            wrong = {one.key: one for one in seen.conditions}
            with self._file.reading() as connection:
                alarms = {one.key: one for one in store.open_alarms_of(connection, twin)}
            ripe = self._ripe(twin, wrong, alarms, seen.judged)
            renewed = [
                alarm.renewed(wrong[key].words)
                for key, alarm in alarms.items()
                if alarm.is_active and key in wrong and _is_news(alarm, wrong[key])
            ]
            if not (ripe or renewed or seen.occurred) and seen.keep is None:
                return
            with self._file.writing() as connection:
                for condition in seen.occurred:
                    self._occur(connection, condition)
                raised = {one.key for one in seen.occurred}
                for key, is_wrong in ripe:
                    if not is_wrong:
                        self._end(connection, key, seen.endings.get(key))
                    elif key not in raised:
                        self._raise(connection, wrong[key])
                for alarm in renewed:
                    self._write(connection, alarm, "renewed", None, "")
                if seen.keep is not None:
                    seen.keep(connection)

    def end_shelves(self) -> None:
        """Bring back what was shelved until now.

        Raises:
            InputError: nothing can be written.
        """
        now = self._clock.now()
        with self._lock:
            due = [one for one in self.open() if one.shelved_until and one.shelved_until <= now]
            if due:
                with self._file.writing() as connection:
                    for alarm in due:
                        self._write(connection, alarm.unshelved(), "unshelved", None, "its time")

    def clear_others(self, twins: Collection[str]) -> None:
        """Clear the alarms of twins that are no longer served.

        Raises:
            InputError: nothing can be written.
        """
        with self._lock:
            gone = [
                one
                for one in self.open()
                if one.is_active and one.twin is not None and one.twin not in twins
            ]
            if gone:
                with self._file.writing() as connection:
                    for alarm in gone:
                        self._clear(connection, alarm.key, "the twin is no longer served")

    def _ripe(
        self,
        twin: str | None,
        wrong: Mapping[ConditionKey, Condition],
        alarms: Mapping[ConditionKey, OperatorAlarm],
        judged: Collection[AlarmKind],
    ) -> list[News]:
        """What is wrong or well for long enough while its alarm says otherwise.

        A condition of which an alarm is raised is news again as soon as it has doubled.
        """
        active = {key: one for key, one in alarms.items() if one.is_active}
        waiting = {(key, True): self._delays[key.kind][0] for key in wrong if key not in active}
        for key in active:
            if key not in wrong and key.kind in judged:
                waiting[key, False] = self._delays[key.kind][1]
        passed = self._waiting.passed(twin, waiting, self._clock.monotonic())
        grown = [key for key, one in active.items() if key in wrong and _doubled(one, wrong[key])]
        return [*passed, *((key, True) for key in grown)]

    def _occur(self, connection: Connection, condition: Condition) -> None:
        """Raise the alarm of what has occurred; what is found again leaves its alarm as it is."""
        known = store.open_alarm(connection, condition.key)
        if condition.is_again and known is not None and known.is_active:
            if set(condition.sensors) <= set(known.sensors):
                return
        else:
            self._clear(connection, condition.key, "another has come")
        self._raise(connection, condition)

    def _raise(self, connection: Connection, condition: Condition) -> None:
        now, known = self._clock.now(), store.open_alarm(connection, condition.key)
        if known is None:
            alarm = OperatorAlarm.begun(store.next_alarm(connection), condition, now)
        else:
            alarm = known.raised_again(condition, now)
        self._write(connection, alarm, "raised", None, "")

    def _end(self, connection: Connection, key: ConditionKey, ending: Ending | None) -> None:
        """Clear the alarm of a condition; whoever has made an end of it has seen the alarm."""
        known = store.open_alarm(connection, key)
        if known is not None and known.is_active and ending is not None:
            known = known.renewed(ending.words)
            if ending.who is not None and (known.is_shelved or known.acknowledged_at is None):
                known = known.decided(ending.who, self._clock.now())
                why = shorten(ending.why, MOST_LETTERS, placeholder=" …")
                self._write(connection, known, "acknowledged", ending.who, why)
            else:
                self._write(connection, known, "renewed", None, "")
        self._clear(connection, key, "")

    def _clear(self, connection: Connection, key: ConditionKey, why: str) -> None:
        known = store.open_alarm(connection, key)
        if known is not None and known.is_active:
            self._write(connection, known.cleared(self._clock.now()), "cleared", None, why)

    def _done(
        self,
        id: int,
        change: Change,
        who: str,
        why: str,
        does: Callable[[OperatorAlarm, datetime], OperatorAlarm],
    ) -> OperatorAlarm:
        """What somebody does about an alarm."""
        if not who.strip():
            raise InputError("nobody is named", f"alarm {id}", "say who asks for it")
        if max(len(who), len(why)) > MOST_LETTERS:
            raise InputError("the reason is too long", f"alarm {id}", f"{MOST_LETTERS} letters do")
        with self._lock, self._file.writing() as connection:
            alarm = does(_there(connection, id), self._clock.now())
            self._write(connection, alarm, change, who, why)
        return alarm

    def _write(
        self,
        connection: Connection,
        alarm: OperatorAlarm,
        change: Change,
        who: str | None,
        why: str,
    ) -> None:
        at = self._clock.now()
        transition = store.write_transition(connection, alarm, change, at, who, why)
        # Of what goes on behind a shelf nobody wants to hear, and of what goes on as it did.
        is_quiet = change == "renewed" or (alarm.is_shelved and change in ("raised", "cleared"))
        if self._tell is not None and not is_quiet:
            self._tell(connection, alarm, transition)


def _doubled(alarm: OperatorAlarm, condition: Condition) -> bool:
    return 0 < 2 * alarm.size <= condition.size


def _is_news(alarm: OperatorAlarm, condition: Condition) -> bool:
    return condition.is_renewed and condition.words != alarm.words


def _there(connection: Connection, id: int) -> OperatorAlarm:
    found = store.alarm_of(connection, id) if 0 < id < MOST_ALARMS else None
    if found is None:
        raise InputError(f"there is no alarm {id}", "alarms", "look at the list of alarms")
    return found
