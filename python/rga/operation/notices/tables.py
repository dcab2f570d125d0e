"""Tables of notices, in the file of the service. Moments are microseconds since 1970 (UTC)."""

from sqlalchemy import Column, Index, Integer, MetaData, Table, Text

from rga.twin.repository.columns import checksum, large_number, text

metadata = MetaData()

# What is to be told of a transition, and the message that told it.
notice = Table(
    "notice",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    text("recipient"),
    Column("twin", Text),
    large_number("alarm"),
    large_number("transition"),
    text("words"),
    large_number("written_at"),
    Column("message", Text),
    checksum(),
    Index("notices_to_tell", "recipient", "message"),
)
# What is sent, and how often that was tried.
message = Table(
    "message",
    metadata,
    text("id", key=True),
    text("recipient"),
    text("title"),
    text("body"),
    large_number("written_at"),
    large_number("tries"),
    large_number("next_try"),
    text("fate"),
    text("fault"),
    checksum(),
    Index("messages_of_fate", "fate", "written_at"),
    Index("messages_of_recipient", "recipient", "fate", "written_at"),
)
