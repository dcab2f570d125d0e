"""Tables of users, sessions and tokens, in the file of a service."""

from sqlalchemy import Column, Float, Integer, MetaData, Table

from rga.twin.repository.columns import checksum, text

metadata = MetaData()


def _moment(name: str) -> "Column[float]":
    return Column(name, Float, nullable=False)


# Moments are seconds since 1970 (UTC).
user = Table("user", metadata, text("name", key=True), text("role"), text("hash"), checksum())
# Of a session and of a token the SHA-256 is kept, so that who reads the file can use neither.
session = Table(
    "session", metadata, text("sha256", key=True), text("user"), _moment("used"), checksum()
)
token = Table(
    "token",
    metadata,
    text("sha256", key=True),
    text("name"),
    text("purpose"),
    text("twin"),
    _moment("made"),
    checksum(),
)
# Logins that failed one after the other, by whom or from where.
failure = Table(
    "failure",
    metadata,
    text("key", key=True),
    Column("count", Integer, nullable=False),
    _moment("last"),
    checksum(),
)
# Who came in, who was refused, and who left.
login = Table(
    "login",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    _moment("at"),
    text("name"),
    text("address"),
    text("outcome"),
    checksum(),
)
