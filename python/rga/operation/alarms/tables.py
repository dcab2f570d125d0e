"""Tables of alarms, in the file of the service. Moments are microseconds since 1970 (UTC)."""

from sqlalchemy import BigInteger, Boolean, Column, Index, Integer, MetaData, Table, Text

from rga.twin.repository.columns import checksum, large_number, text

metadata = MetaData()

# Every alarm as it stands.
alarm = Table(
    "alarm",
    metadata,
    Column("id", Integer, primary_key=True, autoincrement=False),
    Column("twin", Text),
    text("kind"),
    text("cause"),
    text("subject"),
    text("words"),
    text("sensors"),
    large_number("size"),
    large_number("since"),
    large_number("raised_at"),
    Column("cleared_at", BigInteger),
    Column("acknowledged_at", BigInteger),
    Column("acknowledged_by", Text),
    Column("shelved_until", BigInteger),
    Column("shelved_by", Text),
    Column("is_open", Boolean, nullable=False),
    checksum(),
    Index("open_alarms", "is_open", "twin"),
)
# How it came to that: nothing here is ever changed.
transition = Table(
    "transition",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    large_number("alarm"),
    text("change"),
    large_number("at"),
    Column("who", Text),
    text("why"),
    text("words"),
    checksum(),
    Index("transitions_of_alarm", "alarm"),
)
# Up to where each twin was looked at: steps of its run, rows, and its sensors then (JSON).
watched = Table(
    "watched",
    metadata,
    text("twin", key=True),
    text("run"),
    large_number("step"),
    large_number("cell"),
    text("sensors"),
    checksum(),
)
