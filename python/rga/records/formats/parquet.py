"""Parquet files."""

from pathlib import Path

import polars as pl

from rga.errors import InputError
from rga.records.table import Table


def is_parquet(data: bytes, path: Path) -> bool:
    """Whether a file is Parquet by its suffix or its first bytes."""
    return path.suffix.lower() in (".parquet", ".pq") or data.startswith(b"PAR1")


def read_parquet(data: bytes, path: Path) -> Table:
    """Read a Parquet file.

    Raises:
        InputError: it is no complete Parquet file.
    """
    try:
        frame = pl.read_parquet(data)
    except (pl.exceptions.PolarsError, OSError) as error:
        problem = next(iter(str(error).splitlines()), type(error).__name__)
        raise InputError(
            f"this is no complete Parquet file: {problem}",
            str(path),
            "write it again, or copy it again in full",
        ) from None
    return Table(path, frame, "row", 1, format="Parquet")
