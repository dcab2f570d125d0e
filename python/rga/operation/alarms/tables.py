"""Tables of alarms, in the file of the service. Moments are microseconds since 1970 (UTC)."""

from typing import Any

from sqlalchemy import BigInteger, Boolean, Column, Index, Integer, MetaData, Table, Text

from rga.twin.repository.checksum import COLUMN

metadata = MetaData()


def _text(name: str) -> Column[Any]:
    return Column(name, Text, nullable=False)


def _number(name: str) -> Column[Any]:
    return Column(name, BigInteger, nullable=False)


# Every alarm as it stands.
alarm = Table(
    "alarm",
    metadata,
    Column("id", Integer, primary_key=True, autoincrement=False),
    Column("twin", Text),
    _text("kind"),
    _text("cause"),
    _text("subject"),
    _text("words"),
    _text("sensors"),
    _number("size"),
    _number("since"),
    _number("raised_at"),
    Column("cleared_at", BigInteger),
    Column("acknowledged_at", BigInteger),
    Column("acknowledged_by", Text),
    Column("shelved_until", BigInteger),
    Column("shelved_by", Text),
    Column("is_open", Boolean, nullable=False),
    _number(COLUMN),
    Index("open_alarms", "is_open", "twin"),
)
# How it came to that: nothing here is ever changed.
transition = Table(
    "transition",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    _number("alarm"),
    _text("change"),
    _number("at"),
    Column("who", Text),
    _text("why"),
    _text("words"),
    _number(COLUMN),
    Index("transitions_of_alarm", "alarm"),
)
# Up to where each twin was looked at: steps of its run, rows, and its sensors then (JSON).
watched = Table(
    "watched",
    metadata,
    Column("twin", Text, primary_key=True),
    _text("run"),
    _number("step"),
    _number("cell"),
    _text("sensors"),
    _number(COLUMN),
)
