"""Plain delimited text: CSV and its kin, with remarks, names and units above the rows."""

from collections import Counter
from collections.abc import Collection, Sequence

from rga.errors import InputError
from rga.quantities import counted
from rga.records.formats.encoding import Text
from rga.records.formats.rows import open_quote, read_rows
from rga.records.formats.shape import Shape, find_shape, rows_above, split, uncommented
from rga.records.mapping import FileMapping
from rga.records.numbers import notation_of
from rga.records.table import Table
from rga.records.times.named import time_of
from rga.records.units import name_and_unit, states_none, without_brackets

#: bytes at the head of a file by which its shape and its notation are known
HEAD = 1 << 18
#: name of a column that counts the rows and has none
ROW = "row number"
#: lines of numbers among the remarks that are no rows of another table
FEW = 5
SAID = {"\t": "tabs", ";": "semicolons", ",": "commas", "|": "bars", " ": "blanks"}


def read_plain(text: Text, mapping: FileMapping, known: Collection[str]) -> Table:
    """Read delimited text.

    Args:
        text: of the file.
        mapping: what is stated of it.
        known: names that columns may have, such as those of sensors.

    Raises:
        InputError: it holds no table, repeats a column, or has lines of unequal length.
    """
    lines = text.lines(HEAD)
    if not any(line.strip() for line in lines):
        raise InputError("there are no rows in the file", str(text.path), "give a table")
    for key in ("header_line", "units_line", "data_line"):
        stated = getattr(mapping, key)
        if stated is not None and stated > len(lines):
            raise InputError(
                f"{key} = {stated}, but the file has {counted(len(lines), 'line')}",
                str(text.path),
                "mend it",
            )
    shape = find_shape(lines, mapping, {"time", *known})
    above = rows_above(lines, shape) if mapping.header_line is None else 0
    if above > FEW:
        raise InputError(
            f"{above} lines above the names in line {(shape.header or 0) + 1} look like rows",
            str(text.path),
            "state header_line of the table that is meant in import.toml, or give it as a file",
        )
    head = range(shape.data if shape.header is None else shape.header, min(shape.data, len(lines)))
    opened = next((line for line in head if lines[line].count('"') % 2), None)
    if opened is not None:
        raise open_quote(text.path, opened)
    names = _names(lines, shape, text)
    return table_of(text, lines, shape, names, mapping, "plain text")


def table_of(
    text: Text,
    lines: Sequence[str],
    shape: Shape,
    names: Sequence[str],
    mapping: FileMapping,
    format_name: str,
    *,
    body: bytes | None = None,
    ragged: bool = False,
) -> Table:
    """The table of a text whose shape is known.

    Args:
        text: of the file.
        lines: its head.
        shape: of the table.
        names: of its columns.
        mapping: what is stated of the file.
        format_name: as a reader is told.
        body: the rows, where they are not all that is below the head.
        ragged: rows may leave out cells at their end.
    """
    body = text.below(shape.data) if body is None else body
    frame, skipped = read_rows(
        body, shape.delimiter, names, text.path, shape.data, shape.header, ragged=ragged
    )
    units = _units(lines, shape, names)
    bare = {name: name_and_unit(name) for name in frame.columns}
    for name, (_, unit) in bare.items():
        if unit is not None:
            units.setdefault(name, unit)
    head = frame.head(2000)
    cells = (one for column in head.columns for one in head[column].drop_nulls())
    notation = notation_of(cells, mapping.decimal, mapping.thousands)
    warnings = list(text.warnings)
    if notation.doubtful:
        warnings.append(
            'commas before three digits are taken as decimal signs; state decimal = "." and '
            'thousands = "," in import.toml if they part thousands'
        )
    time = time_of(frame, units)
    return Table(
        path=text.path,
        frame=frame,
        row_name="line",
        first=shape.data + 1,
        skipped=skipped,
        format=format_name,
        units=units,
        names={name: one for name, (one, _) in bare.items() if one != name},
        time=time,
        bookkeeping=(ROW,) if ROW in frame.columns else (),
        notation=notation,
        notes=(*text.notes, *_notes(shape, mapping, notation.decimal, notation.thousands)),
        warnings=tuple(warnings),
    )


def _names(lines: Sequence[str], shape: Shape, text: Text) -> list[str]:
    """Names of the columns; those of a file without names are `column 1` and so on."""
    if shape.header is None:
        return [f"column {number + 1}" for number in range(shape.fields)]
    names = split(uncommented(lines[shape.header]), shape.delimiter)
    if not names[0] and _counted(lines, shape):
        names[0] = ROW  # as data frames of Python write their index
    while names and not names[-1] and len(names) > shape.fields:
        names.pop()
    return checked_names(names, text, shape.header)


def _counted(lines: Sequence[str], shape: Shape) -> bool:
    """Whether the first column counts the rows."""
    rows = (line for line in lines[shape.data : shape.data + 20] if line.strip())
    cells = [split(line, shape.delimiter)[0] for line in rows]
    first = cells[0] if cells else ""
    return first in ("0", "1") and cells == [str(int(first) + k) for k in range(len(cells))]


def checked_names(names: list[str], text: Text, line: int, units: Sequence[str] = ()) -> list[str]:
    """Names that are each there once.

    Raises:
        InputError: a name stands twice, or there is none at all.
    """
    where = f"{text.path}, line {line + 1}"
    if not any(names):
        raise InputError("the line of the names is empty", where, "name the columns there")
    if double := twice(names):
        places = [number for number, name in enumerate(names) if name == double]
        said = [units[place] for place in places if place < len(units)]
        as_units = f", in {' and in '.join(said)}" if len(set(said)) > 1 else ""
        raise InputError(
            f"the column {double!r} stands twice{as_units}",
            where,
            "give every column a name of its own",
        )
    return names


def twice(names: Sequence[str]) -> str | None:
    """The first name that stands twice, if one does.

    >>> twice(["a", "b", "", "", "b"])
    'b'
    """
    times = Counter(filter(None, names))
    return next((name for name in times if times[name] > 1), None)


def _units(lines: Sequence[str], shape: Shape, names: Sequence[str]) -> dict[str, str]:
    if shape.units is None or shape.units >= len(lines):
        return {}
    said = (without_brackets(cell) for cell in split(lines[shape.units], shape.delimiter))
    pairs = zip(names, said, strict=False)
    return {name: unit for name, unit in pairs if name and not states_none(unit)}


def _notes(shape: Shape, mapping: FileMapping, decimal: str, thousands: str) -> list[str]:
    """What was found that differs from a CSV file with names in its first line, in one sentence."""
    found = []
    if shape.delimiter != "," and mapping.delimiter is None:
        found.append(f"columns are parted by {SAID.get(shape.delimiter, repr(shape.delimiter))}")
    if decimal == "," and mapping.decimal is None:
        found.append("the decimal sign is a comma")
    if thousands and mapping.thousands is None:
        found.append(f"{thousands!r} parts thousands")
    if shape.header is None:
        found.append("columns have no names and are called 'column 1', 'column 2', ...")
    elif mapping.header_line is None and shape.header > 0:
        found.append(f"names of columns are in line {shape.header + 1}, remarks above")
    if shape.units is not None and mapping.units_line is None:
        found.append(f"units are in line {shape.units + 1}")
    return ["; ".join(found)] if found else []
