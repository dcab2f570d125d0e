"""Parquet files."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from threading import Lock

import polars as pl

from rga.errors import InputError
from rga.records.column_types import readable
from rga.records.formats.bounds import most_values
from rga.records.table import Table

#: bytes of what a file says of itself behind its values
LARGEST_FOOTER = 16 * 2**20
#: the standard error is that of all threads
_STANDARD_ERROR = Lock()


def is_parquet(data: bytes, path: Path) -> bool:
    """Whether a file is Parquet by its suffix or its first bytes."""
    return path.suffix.lower() in (".parquet", ".pq") or data.startswith(b"PAR1")


def read_parquet(data: bytes, path: Path) -> Table:
    """Read a Parquet file.

    Raises:
        InputError: it is no complete Parquet file, holds far more values than its size lets
            measurements be, or times beyond the calendar.
    """
    if (footer := int.from_bytes(data[-8:-4], "little")) > LARGEST_FOOTER and footer < len(data):
        what = f"the file has {footer / 2**20:.0f} MiB of its own description"
        raise InputError(what, str(path), "write it again with fewer groups of rows")
    try:
        with _untold_panics():
            scanned = pl.scan_parquet(BytesIO(data))
            rows = scanned.select(pl.len()).collect().item()
            values = rows * len(scanned.collect_schema())
            if values <= most_values(len(data)):
                return Table(
                    path, readable(pl.read_parquet(data), str(path)), "row", 1, format="Parquet"
                )
    except (pl.exceptions.PolarsError, OSError, pl.exceptions.PanicException) as error:
        problem = next(iter(str(error).splitlines()), type(error).__name__)
        if isinstance(error, pl.exceptions.PanicException):
            problem = "its parts do not fit together"
        raise InputError(
            f"this is no complete Parquet file: {problem}",
            str(path),
            "write it again, or copy it again in full",
        ) from None
    what = f"the file says that it has {values:.3g} values, in {len(data):,} bytes"
    raise InputError(what, str(path), "give what was measured: noise does not compress so far")


@contextmanager
def _untold_panics() -> Iterator[None]:
    """What the library tells of its panics in pages on the standard error is left out."""
    with _STANDARD_ERROR:
        try:
            kept = os.dup(2)
        except OSError:  # there is none
            yield
            return
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, 2)
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            os.close(nowhere)
