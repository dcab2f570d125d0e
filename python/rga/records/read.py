"""Files of loggers as tables: the format is known by what is in them."""

import hashlib
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from rga.bounded_files import bytes_of
from rga.errors import InputError
from rga.records.formats import read_format
from rga.records.mapping import FileMapping
from rga.records.table import Table
from rga.records.units import states_none

#: bytes of a file, beyond which it is not taken into memory
LARGEST_FILE = 4 * 10**9


def read_table(
    path: str | Path, mapping: FileMapping | None = None, known: Collection[str] = ()
) -> Table:
    """Read a file of any format that is known.

    Args:
        path: the file.
        mapping: what is stated of it; None: nothing is.
        known: names that columns may have, such as those of sensors: they tell where names stand.

    Raises:
        InputError: the file is missing, empty or damaged, is of no known format, has no rows,
            repeats a column, or has lines of unequal length.
    """
    path = Path(path)
    if path.is_file() and (size := path.stat().st_size) > LARGEST_FILE:
        raise InputError(
            f"the file has {size / 1e9:.1f} GB, and at most {LARGEST_FILE / 1e9:.1f} are read",
            str(path),
            "part it in time, and give the parts as files of one record",
        )
    data = bytes_of(path, largest=LARGEST_FILE)
    if not data:
        raise InputError("the file is empty", str(path), "give a file with a header and rows")
    table = read_format(data, path, mapping or FileMapping(), known)
    table.check_rows()
    units = {column: unit for column, unit in table.units.items() if not states_none(unit)}
    if table.skipped:
        shown = ", ".join(map(str, table.skipped[:3])) + (", ..." if len(table.skipped) > 3 else "")
        said = f"blank lines between rows are passed over: {len(table.skipped)} (line {shown})"
        table = replace(table, notes=(*table.notes, said))
    return replace(table, units=units, sha256=hashlib.sha256(data).hexdigest())
