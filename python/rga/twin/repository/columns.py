"""Columns that tables of several parts have."""

from sqlalchemy import BigInteger, Column, LargeBinary, Text

from rga.twin.repository.checksum import COLUMN


def text(name: str, *, key: bool = False) -> "Column[str]":
    """A text that every entry has."""
    return Column(name, Text, nullable=False, primary_key=key)


def large_number(name: str, *, key: bool = False) -> "Column[int]":
    """A whole number of 64 bits that every entry has."""
    return Column(name, BigInteger, nullable=False, primary_key=key, autoincrement=False)


def blob(name: str) -> "Column[bytes]":
    """Bytes that every entry has."""
    return Column(name, LargeBinary, nullable=False)


def checksum() -> "Column[int]":
    """The checksum of an entry."""
    return large_number(COLUMN)
