"""Notices on their way: kept with what they tell of, and sent until they have arrived."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from typing import Any, Literal
from uuid import NAMESPACE_URL, uuid4, uuid5

from sqlalchemy import Connection, Row, func, insert, select, update

from rga.operation.alarms.operator_alarm import AlarmTransition, OperatorAlarm
from rga.operation.notices import tables
from rga.operation.notices.notify_settings import NotifySettings
from rga.operation.notices.words import body_of, notice_words, title_of
from rga.operation.service_clock import ServiceClock, microseconds, moment_of
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of

Fate = Literal["waiting", "delivered", "undelivered"]
#: how long notices of a twin are gathered into one message
GATHERED = timedelta(seconds=60)
#: pause after the first time that a message does not arrive, which doubles, and the longest
FIRST_PAUSE, LONGEST_PAUSE = timedelta(seconds=10), timedelta(hours=1)
#: how long it is tried
GIVEN_UP = timedelta(hours=24)
#: tries after which somebody is told that messages do not arrive
FEW_TRIES = 3


@dataclass(frozen=True)
class OutgoingMessage:
    """A message that is sent, or was.

    Attributes:
        id: by which one that arrives twice is known.
        recipient: name of the file of its address.
        title, body: what it says.
        written_at: when it was written (UTC).
        tries: how often it was sent without arriving.
        next_try: when it is sent next (UTC).
        fate: what became of it.
        fault: why it did not arrive; empty: nothing is known of that.
    """

    id: str
    recipient: str
    title: str
    body: str
    written_at: datetime
    tries: int
    next_try: datetime
    fate: Fate
    fault: str


class Outbox:
    """The notices of a service, in its file.

    Args:
        file: of the service.
        recipients: whom notices are for.
        link: address of the pages.
        clock: of the service.

    Raises:
        InputError: the file cannot be written.
    """

    def __init__(
        self,
        file: TableFile,
        recipients: Sequence[NotifySettings],
        link: str,
        clock: ServiceClock,
    ) -> None:
        self._file, self._clock = file, clock
        self._recipients = {one.name: one for one in recipients}
        self._link = f"{link}/alarms"
        with file.writing() as connection:
            tables.metadata.create_all(connection)
            self._give_up_others(connection)

    def add(
        self, connection: Connection, alarm: OperatorAlarm, transition: AlarmTransition
    ) -> None:
        """Keep what is to be told of a transition, in its transaction."""
        topics = {alarm.kind, alarm.cause}
        for recipient in self._recipients.values():
            if topics.isdisjoint(recipient.on):
                continue
            entry = with_checksum(
                number=_last(connection) + 1,
                recipient=recipient.name,
                twin=alarm.twin,
                alarm=alarm.id,
                transition=transition.number,
                words=notice_words(alarm, transition),
                written_at=microseconds(transition.at),
                message=None,
            )
            connection.execute(insert(tables.notice).values(**entry))

    def gather(self, recipient: str) -> None:
        """Write messages of the notices that have waited for others for long enough.

        Where a recipient has got as many messages as it wants, notices wait for the next.

        Raises:
            InputError: nothing can be written.
        """
        now = self._clock.now()
        with self._file.reading() as connection:
            groups = _waiting(connection, recipient).values()
            # Dictionaries keep their order: the group of the oldest notice is the first.
            due = [one for one in groups if _is_over(one[0]["written_at"], GATHERED, now)]
            room = self._room(connection, recipient, now) if due else 0
        if room:
            with self._file.writing() as connection:
                for notices in due[:room]:
                    self._write(connection, recipient, notices, now)

    def add_daily(self, recipient: str, day: str, words: str) -> None:
        """Write the line of a day, once.

        Raises:
            InputError: nothing can be written.
        """
        id = str(uuid5(NAMESPACE_URL, f"{self._link} {recipient} {day}"))
        with self._file.writing() as connection:
            known = select(tables.message.c.id).where(tables.message.c.id == id)
            if connection.execute(known).one_or_none() is None:
                now = self._clock.now()
                body = f"{words}\n{self._link}\nnotice {id}"
                _insert(connection, id, recipient, f"rga, {day}", body, now)

    def due(self, recipient: str) -> list[OutgoingMessage]:
        """The messages that are to be sent now, the oldest first."""
        now, c = self._clock.now(), tables.message.c
        chosen = select(tables.message).where(c.recipient == recipient, c.fate == "waiting")
        with self._file.reading() as connection:
            found = connection.execute(chosen.order_by(c.written_at, c.id))
            waiting = [_message(one) for one in found]
        # A clock that was set back does not keep a message from being sent.
        return [one for one in waiting if not now < one.next_try <= now + LONGEST_PAUSE]

    def tried(self, message: OutgoingMessage, fault: str | None) -> None:
        """A message was sent.

        Args:
            message: it.
            fault: why it did not arrive; None: it did.

        Raises:
            InputError: nothing can be written: it is sent again.
        """
        now, tries = self._clock.now(), message.tries + 1
        values: dict[str, Any] = {"fate": "delivered", "fault": ""}
        if fault is not None:
            over = _is_over(microseconds(message.written_at), GIVEN_UP, now)
            pause = min(FIRST_PAUSE * 2 ** min(message.tries, 20), LONGEST_PAUSE)
            values = {"fate": "undelivered" if over else "waiting", "fault": fault}
            values |= {"tries": tries, "next_try": microseconds(now + pause)}
        with self._file.writing() as connection:
            _update(connection, message.id, values)

    def undelivered(self, limit: int = 1000) -> list[OutgoingMessage]:
        """The last so many messages that did not arrive: given up, or sent again.

        They are in the order in which they were written.
        """
        c = tables.message.c
        found = []
        with self._file.reading() as connection:
            for some in (c.fate == "undelivered", (c.fate == "waiting") & (c.tries > 0)):
                chosen = select(tables.message).where(some).order_by(c.written_at.desc())
                found += [_message(one) for one in connection.execute(chosen.limit(limit))]
        return sorted(found, key=lambda one: (one.written_at, one.id))[-limit:]

    def failing(self) -> dict[str, str]:
        """Why messages do not arrive, by the recipients who do not get theirs."""
        c, failing = tables.message.c, {}
        latest = {one.recipient: one for one in self.undelivered() if one.tries >= FEW_TRIES}
        with self._file.reading() as connection:
            for name, one in latest.items():
                arrived = select(func.max(c.written_at)).where(
                    c.recipient == name, c.fate == "delivered"
                )
                if name in self._recipients and microseconds(one.written_at) > (
                    connection.scalar(arrived) or 0
                ):
                    failing[name] = one.fault
        return failing

    def _room(self, connection: Connection, recipient: str, now: datetime) -> int:
        """How many more messages a recipient wants now."""
        most, span = self._recipients[recipient].at_most
        c, since = tables.message.c, microseconds(now - timedelta(seconds=span))
        recent = select(func.count()).where(c.recipient == recipient, c.written_at > since)
        return max(0, most - int(connection.scalar(recent) or 0))

    def _write(
        self,
        connection: Connection,
        recipient: str,
        notices: Sequence[Mapping[str, Any]],
        now: datetime,
    ) -> None:
        """Write one message of notices of a twin."""
        id, words = str(uuid4()), [str(one["words"]) for one in notices]
        held = sum(_is_over(one["written_at"], 2 * GATHERED, now) for one in notices)
        alarms = {one["alarm"] for one in notices}
        link = f"{self._link}#alarm-{alarms.pop()}" if len(alarms) == 1 else self._link
        title, body = title_of(notices[0]["twin"], words), body_of(words, held, link, id)
        _insert(connection, id, recipient, title, body, now)
        for one in notices:
            same = tables.notice.c.number == one["number"]
            entry = with_checksum(**dict(one) | {"message": id})
            connection.execute(update(tables.notice).where(same).values(**entry))

    def _give_up_others(self, connection: Connection) -> None:
        """Give up what is for recipients who are no longer there."""
        c = tables.message.c
        gone = c.recipient.not_in(list(self._recipients))
        found = select(c.id).where(gone, c.fate == "waiting")
        for id in connection.scalars(found).all():
            _update(connection, id, {"fate": "undelivered", "fault": "it is no longer configured"})


def _is_over(written: int, span: timedelta, now: datetime) -> bool:
    """Whether a span has passed; so it has where the clock was set back meanwhile."""
    return not moment_of(written) <= now < moment_of(written) + span


def _last(connection: Connection) -> int:
    return int(connection.scalar(select(func.max(tables.notice.c.number))) or 0)


def _waiting(connection: Connection, recipient: str) -> dict[str | None, list[dict[str, Any]]]:
    """Notices that no message tells, by twin, in their order."""
    c = tables.notice.c
    chosen = select(tables.notice).where(c.recipient == recipient, c.message.is_(None))
    groups: dict[str | None, list[dict[str, Any]]] = {}
    for entry in connection.execute(chosen.order_by(c.number)):
        values = values_of(tables.notice, entry)
        groups.setdefault(values["twin"], []).append(values)
    return groups


def _insert(
    connection: Connection, id: str, recipient: str, title: str, body: str, now: datetime
) -> None:
    message = OutgoingMessage(id, recipient, title, body, now, 0, now, "waiting", "")
    moments = {"written_at": microseconds(now), "next_try": microseconds(now)}
    entry = with_checksum(**asdict(message) | moments)
    connection.execute(insert(tables.message).values(**entry))


def _update(connection: Connection, id: str, values: Mapping[str, Any]) -> None:
    same = tables.message.c.id == id
    known = values_of(tables.message, connection.execute(select(tables.message).where(same)).one())
    entry = with_checksum(**known | dict(values))
    connection.execute(update(tables.message).where(same).values(**entry))


def _message(entry: Row[Any]) -> OutgoingMessage:
    values = values_of(tables.message, entry)
    moments = {name: moment_of(values[name]) for name in ("written_at", "next_try")}
    return OutgoingMessage(**values | moments)
