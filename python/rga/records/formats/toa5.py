"""TOA5, the text format of Campbell Scientific's loggers.

Source: Campbell Scientific, LoggerNet instruction manual, appendix "File formats": lines of the
station, of the names, of the units and of what was processed, then rows.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rga.errors import InputError
from rga.records.formats.encoding import Text
from rga.records.formats.plain import HEAD, checked_names, table_of
from rga.records.formats.shape import Shape, split
from rga.records.mapping import FileMapping
from rga.records.table import StatedTime, Table

TIME, NUMBER = "TIMESTAMP", "RECORD"
#: lines above the rows: TOACI1 has neither units nor processes
HEADS = {"TOA5": 4, "TOACI1": 2}
#: processes that give a time: when the smallest or largest value fell
TIMES = ("TMn", "TMx", "TmMn", "TmMx")


def is_toa5(first_line: str) -> bool:
    """Whether the first line is that of the format.

    >>> is_toa5('"TOA5","TestLogger","CR1000X"'), is_toa5("time,D1")
    (True, False)
    """
    return split(first_line, ",")[:1] in [[kind] for kind in HEADS]


def read_toa5(text: Text, mapping: FileMapping) -> Table:
    """Read a TOA5 file.

    Raises:
        InputError: it ends within its head, or a name stands twice.
    """
    lines = text.lines(HEAD)
    kind = split(lines[0], ",")[0]
    rows = HEADS[kind]
    if len(lines) < rows:
        raise InputError(
            f"the file ends within the {rows} lines of its head",
            f"{text.path}, line {len(lines)}",
            "copy it again in full",
        )
    head = [split(line, ",") for line in lines[:rows]]
    units = head[2] if rows > 2 else []
    names = checked_names(head[1], text, 1, units)
    shape = Shape(",", 1, 2 if rows > 2 else None, rows, len(names))
    table = table_of(text, lines, shape, names, mapping, kind)
    processes = dict(zip(names, head[3], strict=False)) if rows > 3 else {}
    timed = [name for name in table.frame.columns if processes.get(name) in TIMES]
    stated = {name: unit for name, unit in table.units.items() if unit not in ("TS", "RN")}
    table = replace(
        table,
        units=stated,
        time=StatedTime((TIME,)) if TIME in table.frame.columns else None,
        bookkeeping=(NUMBER,) if NUMBER in table.frame.columns else (),
        notes=(*text.notes, *_notes(head[0], timed, table)),
    )
    return replace(table, warnings=(*table.warnings, *_lost(table)))


def _notes(station: Sequence[str], timed: Sequence[str], table: Table) -> list[str]:
    notes = []
    if len(station) > 2:
        notes.append(f"logger {station[1]} ({station[2]}), table {station[-1]}")
    if timed:
        notes.append(f"{', '.join(timed)} hold times, no numbers")
    stamps = table.frame[TIME].drop_nulls() if TIME in table.frame.columns else None
    if stamps is not None and len(stamps) and stamps.str.ends_with(" 00:00:00").all():
        notes.append("a daily value stamped 00:00:00 is of the day before")
    return notes


def _lost(table: Table) -> list[str]:
    """In words, rows that are missing by their record numbers."""
    if NUMBER not in table.bookkeeping:
        return []
    steps = np.diff(table.numbers(NUMBER))
    lost = steps[np.isfinite(steps) & (steps > 1)] - 1
    return [f"{int(lost.sum())} rows are missing by their record numbers"] if len(lost) else []
