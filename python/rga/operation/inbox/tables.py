"""Tables of packets, in the file of the rows that are made of them."""

from sqlalchemy import (
    BigInteger,
    Column,
    Index,
    Integer,
    MetaData,
    Table,
    Text,
    UniqueConstraint,
)

from rga.twin.repository.columns import blob, checksum, large_number, text

metadata = MetaData()

# What waits for the rows that it is of, was used, or came too late for them. Moments are
# microseconds since 1970 (UTC); those of its samples before `late_before` came too late.
packet = Table(
    "packet",
    metadata,
    Column("id", Integer, primary_key=True),
    text("source"),
    Column("stream", Text),
    Column("sequence", BigInteger),
    Column("sha256", Text),
    text("kind"),
    text("place"),
    large_number("first"),
    large_number("last"),
    Column("late_before", BigInteger),
    large_number("arrived"),
    text("fate"),
    blob("payload"),
    checksum(),
    UniqueConstraint("source", "stream", "sequence"),
    Index("packet_in_time", "fate", "last"),
    Index("packet_by_content", "sha256"),
)
# What cannot be used, and why.
refused = Table(
    "refused",
    metadata,
    Column("id", Integer, primary_key=True),
    text("source"),
    large_number("arrived"),
    text("reason"),
    blob("payload"),
    checksum(),
)
# The numbers of a stream that have come: those below the next, but for the gaps (JSON).
stream = Table(
    "stream",
    metadata,
    text("source", key=True),
    text("stream", key=True),
    large_number("next"),
    text("gaps"),
    checksum(),
)
# Packets of a source by the hour of their arrival, counted as their fate is decided.
account = Table(
    "account",
    metadata,
    text("source", key=True),
    large_number("hour", key=True),
    large_number("received"),
    large_number("used"),
    large_number("duplicate"),
    large_number("late"),
    large_number("partly_late"),
    large_number("refused"),
    checksum(),
)
# How far a source has come: the latest moment that it has sent.
source = Table(
    "source",
    metadata,
    text("name", key=True),
    Column("latest", BigInteger),
    checksum(),
)
# Where a source reads on, by the part of it, such as a file of a folder (JSON).
cursor = Table(
    "cursor",
    metadata,
    text("source", key=True),
    text("part", key=True),
    text("state"),
    checksum(),
)
# One line: the length of the rows [µs].
length = Table("length", metadata, large_number("every"), checksum())
# One line: rows before this moment are final.
sealed = Table("sealed", metadata, large_number("until"), checksum())
# What lies beside the mean of a row: the samples of a cell, by channel and context.
cell = Table(
    "cell",
    metadata,
    large_number("begin", key=True),
    blob("count"),
    blob("deviation"),
    blob("least"),
    blob("most"),
    blob("conflicts"),
    checksum(),
)
