"""Tables of a .s2k file: fields `Name=value` in rows under `TABLE: "NAME"`."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from rga.errors import InputError
from rga.importing.numerals import float_of

FIELD = re.compile(r'([A-Za-z0-9_/.\-() ]+?)\s*=\s*("(?:[^"]|"")*"|\S*)')
HEAD = re.compile(r'TABLE:\s*"([^"]*)"')
#: lines of the longest row, and rows of the longest file
LONGEST_ROW, MOST_ROWS = 200, 300_000


@dataclass(frozen=True)
class TableRow:
    """A row: its fields by name, and the line that it begins in."""

    values: dict[str, str]
    line: int

    @property
    def where(self) -> str:
        """Its place in words."""
        return f"line {self.line}"

    def get(self, name: str, default: str = "") -> str:
        """A field; the default where it is not given."""
        return self.values.get(name.lower(), default)

    def text(self, name: str) -> str:
        """A field that must be given.

        Raises:
            InputError: it is not.
        """
        found = self.get(name)
        if not found:
            raise InputError(f"the field {name} is missing", self.where, "give it")
        return found

    def number(self, name: str, default: float | None = None) -> float:
        """A field as a number.

        Raises:
            InputError: it is not given and has no default, or it is no number.
        """
        found = self.get(name)
        if not found and default is not None:
            return default
        try:
            number = float_of(self.text(name))
        except ValueError:
            raise InputError(
                f"{name} is {found!r}, no number", self.where, "write a number"
            ) from None
        if not abs(number) < 1e300:
            raise InputError(f"{name} is {found!r}, no number", self.where, "write a number")
        return number

    def yes(self, name: str) -> bool:
        """Whether a field says yes.

        Raises:
            InputError: it says neither yes nor no.
        """
        word = self.get(name).lower()
        if word not in ("", "yes", "no"):
            raise InputError(f"{name} is {word!r}, neither Yes nor No", self.where, "write one")
        return word == "yes"


@dataclass
class Tables:
    """Rows of each table, by its name in capitals, and the lines that are of none."""

    rows: dict[str, list[TableRow]] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    others: list[tuple[str, str]] = field(default_factory=list)

    def of(self, name: str) -> list[TableRow]:
        """The rows of a table; none where it is not in the file."""
        return self.rows.get(name, [])

    def by(self, key: str, name: str) -> dict[str, TableRow]:
        """The rows of a table by a field that names each of them.

        Raises:
            InputError: a name stands twice.
        """
        found: dict[str, TableRow] = {}
        for row in self.of(name):
            if row.text(key) in found:
                raise InputError(
                    f"{key} {row.text(key)!r} stands twice in {name!r}, first in line "
                    f"{found[row.text(key)].line}", row.where, "leave one of them",
                )  # fmt: skip
            found[row.text(key)] = row
        return found


def read_tables(text: str, file: str) -> Tables:
    """The tables of a file.

    Raises:
        InputError: there is none, or the file ends before its line END TABLE DATA.
    """
    tables, ended = Tables(), False
    current: list[TableRow] | None = None
    for number, (line, row) in enumerate(_rows(text, file)):
        if number > MOST_ROWS:
            raise InputError(
                f"the file has more than {MOST_ROWS} rows", f"line {line}", "give fewer tables"
            )
        head = HEAD.match(row)
        if head:
            name = head[1].upper()
            current = tables.rows.setdefault(name, [])
            tables.lines.setdefault(name, line)
        elif row.upper().startswith("END TABLE DATA"):
            current, ended = None, True
        elif current is not None:
            current.append(TableRow(_fields(row), line))
        elif not row.startswith("File "):
            tables.others.append((row[:60], f"line {line}"))
    if not tables.rows:
        raise InputError('there is no line TABLE: "..."', file, "export the model as text tables")
    if not ended:
        raise InputError(
            "the file has no line END TABLE DATA: its end is missing", file, "give all of it"
        )
    return tables


def _rows(text: str, file: str) -> Iterator[tuple[int, str]]:
    """Rows that are not empty, those over several lines joined, with their first line."""
    kept: list[str] = []
    first = 0
    for number, line in enumerate(text.split("\n"), start=1):
        stripped = line.strip()
        if not kept:
            first = number
        if stripped.endswith(" _") or stripped == "_":
            kept.append(stripped[:-1].rstrip())
            if len(kept) > LONGEST_ROW:
                raise InputError("a row never ends", f"{file}, line {first}", "mend the file")
            continue
        row = " ".join([*kept, stripped]).strip()
        kept = []
        if row:
            yield first, row
    if kept:
        raise InputError("the file ends within a row", f"{file}, line {first}", "give all of it")


def _fields(row: str) -> dict[str, str]:
    return {
        name.strip().lower(): value[1:-1].replace('""', '"') if value[:1] == '"' else value
        for name, value in FIELD.findall(row)
    }
