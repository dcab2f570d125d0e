"""Formats in which programs write the modes that they found, each read as lines of a modal record.

What is none of them is a table, in any format of records.
"""

import hashlib
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from rga.bounded_files import bytes_of
from rga.records.formats.universal.datasets import is_universal
from rga.records.modal.formats.pyoma2 import arrays_of_file, table_of_arrays
from rga.records.modal.formats.pyoma_netcdf import is_netcdf, read_netcdf
from rga.records.modal.formats.universal_modes import read_universal_modes
from rga.records.read import LARGEST_FILE, read_table
from rga.records.table import Table

__all__ = ["read_modal_table"]


def read_modal_table(path: str | Path, known: Collection[str]) -> Table:
    """Read a file of modes, whose format is known by its content.

    Args:
        path: the file.
        known: names that columns may have.

    Raises:
        InputError: it is missing, damaged, empty or of no known format.
        MissingPackageError: a package that reads the format is not installed.
    """
    path = Path(path)
    data = bytes_of(path, largest=LARGEST_FILE)
    table = _foreign(data, path)
    if table is None:
        return read_table(path, known=known)
    return replace(table, sha256=hashlib.sha256(data).hexdigest())


def _foreign(data: bytes, path: Path) -> Table | None:
    if is_netcdf(data):
        return read_netcdf(data, path)
    if is_universal(data, path):
        return read_universal_modes(path)
    arrays = arrays_of_file(data, path)
    return None if arrays is None else table_of_arrays(arrays, path)
