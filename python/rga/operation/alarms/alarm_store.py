"""Alarms and their transitions as they are kept."""

import json
from dataclasses import asdict
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, func, insert, select, update

from rga.operation.alarms import tables
from rga.operation.alarms.condition import ConditionKey
from rga.operation.alarms.operator_alarm import AlarmTransition, Change, OperatorAlarm
from rga.operation.service_clock import microseconds, moment_of
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import values_of

#: columns that hold moments
_MOMENTS = ("since", "raised_at", "cleared_at", "acknowledged_at", "shelved_until")


def open_alarms(connection: Connection) -> list[OperatorAlarm]:
    """All that are not closed, in the order in which they were first raised."""
    chosen = select(tables.alarm).where(tables.alarm.c.is_open).order_by(tables.alarm.c.id)
    return [_alarm(one) for one in connection.execute(chosen)]


def open_alarms_of(connection: Connection, twin: str | None) -> list[OperatorAlarm]:
    """Those of a twin, or of the service itself (None)."""
    c = tables.alarm.c
    own = c.twin.is_(None) if twin is None else c.twin == twin
    chosen = select(tables.alarm).where(c.is_open, own).order_by(c.id)
    return [_alarm(one) for one in connection.execute(chosen)]


def open_alarm(connection: Connection, key: ConditionKey) -> OperatorAlarm | None:
    """The one of a condition; None: there is none."""
    c = tables.alarm.c
    own = c.twin.is_(None) if key.twin is None else c.twin == key.twin
    same = (c.kind == key.kind) & (c.cause == key.cause) & (c.subject == key.subject)
    found = connection.execute(select(tables.alarm).where(c.is_open, own, same)).one_or_none()
    return None if found is None else _alarm(found)


def newest_alarms(connection: Connection, limit: int) -> list[OperatorAlarm]:
    """The last so many, open or closed, the newest first."""
    chosen = select(tables.alarm).order_by(tables.alarm.c.id.desc()).limit(limit)
    return [_alarm(one) for one in connection.execute(chosen)]


def alarm_of(connection: Connection, id: int) -> OperatorAlarm | None:
    """The alarm of a number; None: there is none."""
    chosen = select(tables.alarm).where(tables.alarm.c.id == id)
    found = connection.execute(chosen).one_or_none()
    return None if found is None else _alarm(found)


def next_alarm(connection: Connection) -> int:
    """The number that the next alarm has."""
    return 1 + int(connection.scalar(select(func.max(tables.alarm.c.id))) or 0)


def transitions_after(connection: Connection, number: int, limit: int) -> list[AlarmTransition]:
    """The transitions behind a number, in their order."""
    c = tables.transition.c
    chosen = select(tables.transition).where(c.number > number).order_by(c.number).limit(limit)
    return [_transition(one) for one in connection.execute(chosen)]


def last_transition(connection: Connection) -> int:
    """Number of the newest; 0: there is none."""
    return int(connection.scalar(select(func.max(tables.transition.c.number))) or 0)


def transitions_of(connection: Connection, alarm: int) -> list[AlarmTransition]:
    """The life of an alarm."""
    c = tables.transition.c
    chosen = select(tables.transition).where(c.alarm == alarm).order_by(c.number)
    return [_transition(one) for one in connection.execute(chosen)]


def write_transition(
    connection: Connection,
    alarm: OperatorAlarm,
    change: Change,
    at: datetime,
    who: str | None,
    why: str,
) -> AlarmTransition:
    """Keep an alarm as it stands, and how it came to that."""
    values = asdict(alarm) | {"is_open": alarm.state != "closed"}
    values["sensors"] = json.dumps(alarm.sensors)
    values |= {name: _kept(values[name]) for name in _MOMENTS}
    entry = with_checksum(**values)
    if alarm_of(connection, alarm.id) is None:
        connection.execute(insert(tables.alarm).values(**entry))
    else:
        same = tables.alarm.c.id == alarm.id
        connection.execute(update(tables.alarm).where(same).values(**entry))
    transition = AlarmTransition(
        last_transition(connection) + 1, alarm.id, change, at, who, why, alarm.words
    )
    entry = with_checksum(**asdict(transition) | {"at": microseconds(at)})
    connection.execute(insert(tables.transition).values(**entry))
    return transition


def _kept(moment: datetime | None) -> int | None:
    return None if moment is None else microseconds(moment)


def _alarm(entry: Row[Any]) -> OperatorAlarm:
    values = values_of(tables.alarm, entry)
    values.pop("is_open")
    values["sensors"] = tuple(json.loads(values["sensors"]))
    for name in _MOMENTS:
        if values[name] is not None:
            values[name] = moment_of(values[name])
    return OperatorAlarm(**values)


def _transition(entry: Row[Any]) -> AlarmTransition:
    values = values_of(tables.transition, entry)
    return AlarmTransition(**values | {"at": moment_of(values["at"])})
