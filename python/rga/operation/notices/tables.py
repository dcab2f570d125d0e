"""Tables of notices, in the file of the service. Moments are microseconds since 1970 (UTC)."""

from typing import Any

from sqlalchemy import BigInteger, Column, Index, Integer, MetaData, Table, Text

from rga.twin.repository.checksum import COLUMN

metadata = MetaData()


def _text(name: str) -> Column[Any]:
    return Column(name, Text, nullable=False)


def _number(name: str) -> Column[Any]:
    return Column(name, BigInteger, nullable=False)


# What is to be told of a transition, and the message that told it.
notice = Table(
    "notice",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    _text("recipient"),
    Column("twin", Text),
    _number("alarm"),
    _number("transition"),
    _text("words"),
    _number("written_at"),
    Column("message", Text),
    _number(COLUMN),
    Index("notices_to_tell", "recipient", "message"),
)
# What is sent, and how often that was tried.
message = Table(
    "message",
    metadata,
    Column("id", Text, primary_key=True),
    _text("recipient"),
    _text("title"),
    _text("body"),
    _number("written_at"),
    _number("tries"),
    _number("next_try"),
    _text("fate"),
    _text("fault"),
    _number(COLUMN),
    Index("messages_of_fate", "fate", "written_at"),
    Index("messages_of_recipient", "recipient", "fate", "written_at"),
)
