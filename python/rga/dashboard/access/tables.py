"""Tables of users, sessions and tokens, in the file of a service."""

from sqlalchemy import Column, Float, Integer, MetaData, Table, Text

from rga.twin.repository.checksum import COLUMN

metadata = MetaData()


def _text(name: str, key: bool = False) -> "Column[str]":
    return Column(name, Text, nullable=False, primary_key=key)


def _moment(name: str) -> "Column[float]":
    return Column(name, Float, nullable=False)


def _checksum() -> "Column[int]":
    return Column(COLUMN, Integer, nullable=False)


# Moments are seconds since 1970 (UTC).
user = Table("user", metadata, _text("name", key=True), _text("role"), _text("hash"), _checksum())
# Of a session and of a token the SHA-256 is kept, so that who reads the file can use neither.
session = Table(
    "session", metadata, _text("sha256", key=True), _text("user"), _moment("used"), _checksum()
)
token = Table(
    "token",
    metadata,
    _text("sha256", key=True),
    _text("name"),
    _text("purpose"),
    _text("twin"),
    _moment("made"),
    _checksum(),
)
# Logins that failed one after the other, by whom or from where.
failure = Table(
    "failure",
    metadata,
    _text("key", key=True),
    Column("count", Integer, nullable=False),
    _moment("last"),
    _checksum(),
)
# Who came in, who was refused, and who left.
login = Table(
    "login",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    _moment("at"),
    _text("name"),
    _text("address"),
    _text("outcome"),
    _checksum(),
)
