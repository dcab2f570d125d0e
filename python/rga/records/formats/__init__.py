"""Formats in which loggers write, one a file; each gives the common raw table."""

from collections.abc import Collection
from pathlib import Path

from rga.records.formats.encoding import decoded
from rga.records.formats.parquet import is_parquet, read_parquet
from rga.records.formats.plain import read_plain
from rga.records.mapping import FileMapping
from rga.records.table import Table

__all__ = ["read_format"]


def read_format(
    data: bytes, path: Path, mapping: FileMapping, known: Collection[str] = ()
) -> Table:
    """The table of a file, whose format is known by its first bytes or lines.

    Args:
        data: what is in the file.
        path: the file.
        mapping: what is stated of it.
        known: names that columns may have.

    Raises:
        InputError: it is damaged, or of no format that is known.
    """
    if is_parquet(data, path):
        return read_parquet(data, path)
    text = decoded(data, path, mapping.encoding)
    return read_plain(text, mapping, known)
