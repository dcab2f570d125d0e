"""Tables of packets, in the file of the rows that are made of them."""

from sqlalchemy import (
    BigInteger,
    Column,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    Text,
    UniqueConstraint,
)

from rga.twin.repository.checksum import COLUMN

metadata = MetaData()


def _number(name: str, key: bool = False) -> "Column[int]":
    return Column(name, BigInteger, nullable=False, primary_key=key, autoincrement=False)


# What waits for the rows that it is of, was used, or came too late for them. Moments are
# microseconds since 1970 (UTC); those of its samples before `late_before` came too late.
packet = Table(
    "packet",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("source", Text, nullable=False),
    Column("stream", Text),
    Column("sequence", BigInteger),
    Column("sha256", Text),
    Column("kind", Text, nullable=False),
    Column("place", Text, nullable=False),
    _number("first"),
    _number("last"),
    Column("late_before", BigInteger),
    _number("arrived"),
    Column("fate", Text, nullable=False),
    Column("payload", LargeBinary, nullable=False),
    _number(COLUMN),
    UniqueConstraint("source", "stream", "sequence"),
    Index("packet_in_time", "fate", "last"),
    Index("packet_by_content", "sha256"),
)
# What cannot be used, and why.
refused = Table(
    "refused",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("source", Text, nullable=False),
    _number("arrived"),
    Column("reason", Text, nullable=False),
    Column("payload", LargeBinary, nullable=False),
    _number(COLUMN),
)
# The numbers of a stream that have come: those below the next, but for the gaps (JSON).
stream = Table(
    "stream",
    metadata,
    Column("source", Text, primary_key=True),
    Column("stream", Text, primary_key=True),
    _number("next"),
    Column("gaps", Text, nullable=False),
    _number(COLUMN),
)
# Packets of a source by the hour of their arrival, counted as their fate is decided.
account = Table(
    "account",
    metadata,
    Column("source", Text, primary_key=True),
    _number("hour", key=True),
    _number("received"),
    _number("used"),
    _number("duplicate"),
    _number("late"),
    _number("partly_late"),
    _number("refused"),
    _number(COLUMN),
)
# How far a source has come: the latest moment that it has sent.
source = Table(
    "source",
    metadata,
    Column("name", Text, primary_key=True),
    Column("latest", BigInteger),
    _number(COLUMN),
)
# Where a source reads on, by the part of it, such as a file of a folder (JSON).
cursor = Table(
    "cursor",
    metadata,
    Column("source", Text, primary_key=True),
    Column("part", Text, primary_key=True),
    Column("state", Text, nullable=False),
    _number(COLUMN),
)
# One line: rows before this moment are final.
sealed = Table("sealed", metadata, _number("until"), _number(COLUMN))
# What lies beside the mean of a row: the samples of a cell, by channel and context.
cell = Table(
    "cell",
    metadata,
    _number("begin", key=True),
    Column("count", LargeBinary, nullable=False),
    Column("deviation", LargeBinary, nullable=False),
    Column("least", LargeBinary, nullable=False),
    Column("most", LargeBinary, nullable=False),
    Column("conflicts", LargeBinary, nullable=False),
    _number(COLUMN),
)
