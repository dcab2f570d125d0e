"""Text that HBM's catman exports: a head with `T0 = ...`, names with units, tabs."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rga.errors import InputError
from rga.records.formats.blocks import chosen_block
from rga.records.formats.encoding import Text
from rga.records.formats.plain import HEAD, checked_names, table_of
from rga.records.formats.shape import Shape, is_units, is_value, split
from rga.records.mapping import FileMapping
from rga.records.table import StatedTime, Table
from rga.records.times.written import moments_by, written_format

#: the column of the time of a group of channels with one rate
TIME = re.compile(r"(Time|Zeit)\s+\d+\s+-\s.*")
#: what catman writes where an amplifier overflows
OVERFLOW = "-1000000"
_START = re.compile(r"T0\s*=\s*(?P<stamp>\d[^\t;]*\d)(?P<half>\s*[AaPp][Mm])?")
#: lines at the head in which the names are looked for
_LINES = 200


def catman_names(lines: Sequence[str]) -> int | None:
    """The line of the names of a catman export; None: this is none.

    >>> catman_names(["T0 = 01.02.2024 10:00:00", "Zeit  1 - Standardmessrate [s]\\tMS1 [µm/m]"])
    1
    """
    for number, line in enumerate(lines[:_LINES]):
        cells = line.split("\t")
        if len(cells) > 1 and TIME.fullmatch(cells[0].strip().strip('"')):
            return number
    return None


def read_catman_text(text: Text, header: int, mapping: FileMapping) -> Table:
    """Read a catman export.

    Args:
        text: of the file.
        header: line of the names.
        mapping: what is stated of the file.

    Raises:
        InputError: there are no rows, or a name stands twice.
    """
    lines = text.lines(HEAD)
    names = split(lines[header], "\t")
    while names and not names[-1]:
        names.pop()
    checked_names(names, text, header)
    shape = _shape(lines, header, len(names), mapping, text)
    table = table_of(text, lines, shape, names, mapping, "catman text", ragged=True)
    start, notes = _start(lines[:header], lines[header : shape.data])
    groups = [
        [column for column in names if column and time <= names.index(column) < end]
        for time, end in _groups(names)
    ]
    said = [f"{len(group) - 1} channels with the time {group[0]!r}" for group in groups]
    first, *others = groups
    kept = list(first)
    apart = []
    for group in others:
        if _same_rows(table, first[0], group[0]):
            kept += group
        else:
            apart.append(group)
    if apart and mapping.block is None:
        _, more = chosen_block([kept, *apart], [said[0], *said[-len(apart) :]], None, text.path)
        notes += more
    elif mapping.block is not None:
        kept, _ = chosen_block(groups, said, mapping.block, text.path)
    times = [column for column in kept if TIME.fullmatch(table.names.get(column, column))]
    if len(times) > 1:
        notes.append(f"{', '.join(times[1:])} agree with {times[0]}, which is taken")
    frame = table.frame.select(kept)
    frame = frame.filter(frame[times[0]].is_not_null())
    return replace(
        table,
        frame=frame,
        time=StatedTime((times[0],), start=start),
        bookkeeping=tuple(times[1:]),
        missing=(OVERFLOW,),
        notes=(*table.notes, *notes),
    )


def _shape(
    lines: Sequence[str], header: int, fields: int, mapping: FileMapping, text: Text
) -> Shape:
    """Where the rows begin, and the units if they have a line of their own."""
    units = None
    for number in range(header + 1, len(lines)):
        cells = split(lines[number], "\t")
        held = [cell for cell in cells[:fields] if cell]
        if len(held) > fields / 2 and all(is_value(cell, mapping.missing) for cell in held):
            return Shape("\t", header, units, number, fields)
        if units is None and is_units(cells):
            units = number
    raise InputError("there are no rows below the header", str(text.path), "give at least one row")


def _start(head: Sequence[str], channels: Sequence[str]) -> tuple[str | None, list[str]]:
    """The time stamp at which the time is 0, and a note of it."""
    for line in (*head, *channels):
        if found := _START.search(line):
            stamp = found["stamp"] + (found["half"] or "")
            pattern = written_format([stamp])
            moments = moments_by([stamp], pattern) if pattern else None
            if moments:
                return moments[0].isoformat(), ["the start T0 has no time zone"]
            return None, [f"the start T0 = {stamp} can be read in two ways: seconds are taken"]
    return None, ["the head has no start T0: seconds are taken"]


def _groups(names: Sequence[str]) -> list[tuple[int, int]]:
    """Columns of each time and the channels behind it."""
    times = [k for k, name in enumerate(names) if TIME.fullmatch(name)]
    return list(zip(times, [*times[1:], len(names)], strict=True))


def _same_rows(table: Table, one: str, other: str) -> bool:
    """Whether two columns of time are less than half a step apart in every row."""
    first, second = table.numbers(one), table.numbers(other)
    if len(first) < 2:
        return bool(np.array_equal(first, second))
    return bool((np.abs(first - second) < np.median(np.diff(first)) / 2).all())
