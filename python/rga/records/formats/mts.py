"""Text of MTS 793, the software of testing machines.

Its first line names it and its signs: `MTS793|MPT|DEU|1|2|,|.|:|49|1|1|A` has a decimal comma.
Remarks follow, and one block or several of a title, names, units and rows, parted by tabs.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from rga.errors import InputError
from rga.records.formats.blocks import chosen_block
from rga.records.formats.encoding import Text
from rga.records.formats.plain import checked_names, table_of
from rga.records.formats.shape import Shape, is_units, is_value, split
from rga.records.mapping import FileMapping
from rga.records.table import Table

MARK = "MTS793|"
#: day numbers of a spreadsheet, 1982 to 2064
_DAYS = (30000, 60000)


@dataclass(frozen=True)
class _Block:
    title: int
    names: tuple[str, ...]
    end: int

    @property
    def first(self) -> int:
        return self.title + 3


def read_mts(text: Text, mapping: FileMapping) -> Table:
    """Read a block of an MTS 793 file: the first, unless `block` is stated.

    Raises:
        InputError: it has no block, or not the one stated.
    """
    lines = text.lines()
    signs = lines[0].split("|")
    decimal = signs[5] if len(signs) > 5 and signs[5] in (".", ",") else None
    blocks = _blocks(lines)
    if not blocks:
        raise InputError(
            "no table of names, units and rows is in the file",
            str(text.path),
            "copy it again in full, or export it as CSV",
        )
    said = [f"{len(one.names)} columns and {one.end - one.first} rows" for one in blocks]
    block, notes = chosen_block(blocks, said, mapping.block, text.path)
    names = checked_names(list(block.names), text, block.title + 1)
    shape = Shape("\t", block.title + 1, block.title + 2, block.first, len(names))
    stated = mapping.model_copy(update={"decimal": mapping.decimal or decimal})
    body = "\n".join(lines[block.first : block.end]).encode()
    table = table_of(text, lines, shape, names, stated, "MTS 793", body=body)
    dates = [name for name in names if table.units.get(name) == "d" and _is_date(table, name)]
    for name in dates:
        day = datetime(1899, 12, 30) + timedelta(days=int(table.numbers(name)[0]))
        notes.append(f"{name} is the day number of a spreadsheet: it begins on {day.date()}")
    return replace(table, bookkeeping=tuple(dates), notes=(*text.notes, *notes))


def _blocks(lines: Sequence[str]) -> list[_Block]:
    """Titles followed by names, units and rows; a blank line ends a block."""
    blocks = []
    end = 0
    for k in range(len(lines) - 3):
        if k < end or not lines[k].strip():
            continue
        names, units, row = (split(lines[k + below], "\t") for below in (1, 2, 3))
        count = len(names)
        if count < 2 or len(units) != count or not is_units(units):
            continue
        if len(row) != count or not all(is_value(cell) for cell in row if cell):
            continue
        end = next((n for n in range(k + 3, len(lines)) if not lines[n].strip()), len(lines))
        blocks.append(_Block(k, tuple(names), end))
    return blocks


def _is_date(table: Table, name: str) -> bool:
    days = table.numbers(name)
    return bool(((days > _DAYS[0]) & (days < _DAYS[1])).all())
