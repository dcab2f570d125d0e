"""Where names, units and rows stand in a table of text, and what separates its columns."""

import csv
import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from rga.records.mapping import FileMapping
from rga.records.numbers import MINUS, MISSING_WORDS, THOUSANDS
from rga.records.units import name_and_unit, states_none, unit_of, without_brackets

#: in the order in which they are taken where several fit; a blank stands for any run of them
DELIMITERS = ("\t", ";", ",", "|", " ")
_NUMBER = re.compile(
    rf"(?=[+{MINUS}-]?[.,]?\d)[+{MINUS}-]?(\d{{1,3}}([{THOUSANDS}.,]\d{{3}})+|\d+)?([.,]\d*)?([eEdD][+-]?\d+)?"
)
_TIME = re.compile(
    r"(\d{1,4}[-./]\d{1,2}[-./]\d{1,4}|\d{1,2}[-. ]?[A-Za-z]{3}[-. ]?\d{2,4})?[T ]*"
    r"(\d{1,2}:\d{2}(:\d{2}([.,:]\d+)?)?)?\s*([AaPp][Mm]|Z|[+-]\d\d:?\d\d)?"
)
#: rows at the end of the head of a file by which its columns are known
TAIL = 60
#: share of a column's cells that are numbers or times, above which it holds such
MOSTLY = 0.8


@dataclass(frozen=True)
class Shape:
    """Where a table of text has what, lines counted from 0.

    Attributes:
        delimiter: between columns; a blank: runs of white space.
        header: line of the names; None: the columns have none.
        units: line of the units; None: there is none.
        data: line of the first row.
        fields: how many a row has.
    """

    delimiter: str
    header: int | None
    units: int | None
    data: int
    fields: int


def split(line: str, delimiter: str) -> list[str]:
    """Cells of a line.

    >>> split('a;"b;c";', ";"), split("  1   2 ", " ")
    (['a', 'b;c', ''], ['1', '2'])
    """
    if delimiter == " ":
        return line.split()
    try:
        cells = next(csv.reader([line], delimiter=delimiter), [])
    except csv.Error:  # a field beyond all bounds
        cells = line.split(delimiter)
    return [cell.strip() for cell in cells]


def uncommented(line: str) -> str:
    """A line without a sign of comment before its first name.

    >>> uncommented("# time D1"), uncommented("#;time;D1")
    ('time D1', '#;time;D1')
    """
    return re.sub(r"^[#%]+\s*(?=\w)", "", line)


def is_value(cell: str, missing: Collection[str] = ()) -> bool:
    """Whether a cell is a number, a time, or says that a value is missing.

    >>> [is_value(cell) for cell in ("7,90E-2", "1 234.5", "01.09.2014 13:25:39", "NAN", "Kraft")]
    [True, True, True, True, False]
    """
    if cell in MISSING_WORDS or cell in missing:
        return True
    return any(one.isdigit() for one in cell) and bool(
        _NUMBER.fullmatch(cell) or _TIME.fullmatch(cell)
    )


def find_shape(lines: Sequence[str], mapping: FileMapping, known: Collection[str]) -> Shape:
    """The shape of a table of text.

    Args:
        lines: the head of the file.
        mapping: what is stated of it.
        known: names that columns may have, such as those of sensors.
    """
    numbered = [(n, uncommented(line)) for n, line in enumerate(lines) if line.strip()]
    if mapping.data_line is not None or mapping.header_line is not None:
        first = (mapping.header_line or mapping.data_line or 1) - 1
        numbered = [one for one in numbered if one[0] >= first]
    delimiter = mapping.delimiter or _delimiter([line for _, line in numbered], mapping.missing)
    rows = [(n, split(line, delimiter)) for n, line in numbered]
    tail = [cells for _, cells in rows[-TAIL:]]
    fields = _usual([len(cells) for cells in tail])
    if mapping.header_line is not None or not rows:
        return _stated(rows, delimiter, fields, mapping)
    kinds = _valued(tail, fields, mapping.missing)
    data = _first_row(rows, fields, kinds, mapping)
    return _headed(rows, data, delimiter, fields, kinds, mapping, {name.lower() for name in known})


def _delimiter(lines: list[str], missing: Collection[str]) -> str:
    """What parts the most lines of the tail alike into cells that are values."""
    best, chosen = 0.0, ","
    lower = lines[-max(len(lines) // 2, 1) :][-TAIL:]
    for delimiter in DELIMITERS:
        tail = [split(line, delimiter) for line in lower]
        fields = _usual([len(cells) for cells in tail])
        if fields < 2:
            continue
        alike = [cells for cells in tail if len(cells) == fields]
        cells = [cell for row in alike for cell in row if cell]
        values = sum(is_value(cell, missing) for cell in cells)
        share = (0.01 + values / max(len(cells), 1)) * len(alike) / len(tail)
        # A text with blanks in it is no table.
        if share > best + 1e-9 and (delimiter != " " or share > 0.9):
            best, chosen = share, delimiter
    return chosen


def _usual(counts: list[int]) -> int:
    """How many cells rows have: most of the last, else most of all."""
    if not counts:
        return 0
    (last, times), *_ = Counter(counts[-3:]).most_common(1)
    return last if times > 1 else Counter(counts).most_common(1)[0][0]


def _valued(tail: list[list[str]], fields: int, missing: Collection[str]) -> list[bool]:
    """Whether each column holds numbers or times."""
    alike = [cells for cells in tail if len(cells) == fields]
    # The upper half of a small file has its names.
    for rows in (alike[-max(len(alike) // 2, 1) :], alike[-1:]):
        kinds = []
        for column in range(fields):
            cells = [row[column] for row in rows if row[column]]
            good = sum(is_value(cell, missing) for cell in cells)
            kinds.append(bool(cells) and good >= MOSTLY * len(cells))
        if any(kinds):
            return kinds
    return [False] * fields


def _is_row(cells: list[str], fields: int, kinds: list[bool], missing: Collection[str]) -> bool:
    if len(cells) != fields or not any(kinds) or not any(cells):
        return False
    return all(
        not kind or not cell or is_value(cell, missing)
        for cell, kind in zip(cells, kinds, strict=True)
    )


def _first_row(
    rows: list[tuple[int, list[str]]], fields: int, kinds: list[bool], mapping: FileMapping
) -> int | None:
    """Index among rows of the first that is data, as are those that follow it."""
    good = [_is_row(cells, fields, kinds, mapping.missing) for _, cells in rows]
    # A line of dashes below the names states that there are no units, and no missing values.
    held = [any(one.isdigit() for cell in cells for one in cell) for _, cells in rows]
    return next((k for k, one in enumerate(good) if one and held[k] and all(good[k : k + 3])), None)


def _headed(
    rows: list[tuple[int, list[str]]],
    data: int | None,
    delimiter: str,
    fields: int,
    kinds: list[bool],
    mapping: FileMapping,
    known: set[str],
) -> Shape:
    """The shape with the lines of names and units found above the data."""
    if data is None:
        data = len(rows) if not any(kinds) else min(1, len(rows))
    above: list[int] = []
    for k in range(data - 1, -1, -1):
        count = len(rows[k][1])
        while count and rows[k][1][count - 1] == "":
            count -= 1
        named = not above and (count > 1 or fields == 1)
        if named or count == fields or _hits(rows[k][1], known) > 1:
            above.insert(0, k)
        else:
            break
    if not above:
        return Shape(delimiter, None, None, rows[0][0], fields)
    units = next((k for k in above[1:] if is_units(rows[k][1])), None)
    names = _names_row(rows, above, units, kinds, known, mapping.missing)
    if units is not None and units <= names:
        units = None
    first = (units if units is not None else names) + 1
    line = rows[first][0] if first < len(rows) else rows[-1][0] + 1
    if mapping.units_line is not None:
        line = max(line, mapping.units_line)
    # Blank lines right below the names are rows without a value, to be found as such.
    line = min(line, rows[first - 1][0] + 1) if mapping.units_line is None else line
    units_line = rows[units][0] if units is not None else None
    stated = mapping.units_line - 1 if mapping.units_line else units_line
    return Shape(delimiter, rows[names][0], stated, (mapping.data_line or line + 1) - 1, fields)


def _names_row(
    rows: list[tuple[int, list[str]]],
    above: list[int],
    units: int | None,
    kinds: list[bool],
    known: set[str],
    missing: Collection[str],
) -> int:
    hits = {k: _hits(rows[k][1], known) for k in above if k != units}
    most = max(hits.values())
    if most:
        return next(k for k in above if hits.get(k) == most)
    if units is not None:
        return max(k for k in above if k < units)
    texts = [
        k
        for k in above
        if sum(bool(cell) and not is_value(cell, missing) for cell in rows[k][1])
        >= 0.5 * max(sum(map(bool, rows[k][1])), 1)
    ]
    return texts[-1] if texts and any(kinds) else above[0]


def _hits(cells: list[str], known: set[str]) -> int:
    return sum(cell.lower() in known or name_and_unit(cell)[0].lower() in known for cell in cells)


def rows_above(lines: Sequence[str], shape: Shape) -> int:
    """How many lines above the names look like rows of another table.

    >>> rows_above(["a;b", "1;2", "3;4", "c;d;e", "5;6;7"], Shape(";", 3, None, 4, 3))
    2
    """
    count = 0
    for line in lines[: shape.header or 0]:
        cells = [cell for cell in split(line, shape.delimiter) if cell]
        count += len(cells) > 1 and all(is_value(cell) for cell in cells)
    return count


def is_units(cells: list[str]) -> bool:
    """Whether a line states units: all in brackets, or most of them known.

    >>> is_units(["(s)", "(m)"]), is_units(["d", "s", "kN", "kImp"]), is_units(["time", "D1"])
    (True, True, False)
    """
    said = [cell for cell in cells if cell]
    if not said or any(is_value(cell) and cell not in MISSING_WORDS for cell in said):
        return False
    if all(without_brackets(cell) != cell for cell in said):
        return True
    return sum(states_none(cell) or unit_of(cell) is not None for cell in said) > 0.5 * len(said)


def _stated(
    rows: list[tuple[int, list[str]]], delimiter: str, fields: int, mapping: FileMapping
) -> Shape:
    header = (mapping.header_line or 1) - 1
    units = mapping.units_line - 1 if mapping.units_line else None
    if units is None and mapping.data_line is None:
        below = next(((n, cells) for n, cells in rows if n > header), None)
        units = below[0] if below and is_units(below[1]) else None
    first = max(header, -1 if units is None else units) + 1
    data = first if mapping.data_line is None else mapping.data_line - 1
    return Shape(delimiter, header, units, data, fields)
