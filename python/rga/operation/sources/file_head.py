"""The lines above the rows of a text file that grows, and where such lines come again."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from rga.errors import InputError
from rga.records.mapping import HEAD_LINES, FileMapping
from rga.records.units import name_and_unit

#: bytes in which the lines above the rows have to be found, with a row
LOOKED_AT = 1 << 16
#: lines among which the first row is looked for, and rows that say as much where no name is known
MOST_LINES, UNKNOWN_ROWS = 200, 3
_TOA5 = re.compile(rb'"?TOA5"?,')
#: with which a file in UTF-8 may begin
_MARK = b"\xef\xbb\xbf"


@dataclass(frozen=True)
class HeadLines:
    """Lines above rows.

    Attributes:
        count: of them.
        names: which of them has the names of the columns, counted from 0; None: none has.
    """

    count: int
    names: int | None


@dataclass(frozen=True)
class HeadFinder:
    """Finds the lines above the rows of files of a logger.

    Attributes:
        mapping: of the logger.
        known: names that columns may have.
        headless: whether nothing stands above the rows.

    >>> finder = HeadFinder(FileMapping(), {"D1"})
    >>> finder.find([b"Logger X", b"time,D1", b",cm", b"2026-11-23T00:00:00Z,1.5"])
    HeadLines(count=3, names=1)
    >>> finder.find([b"time,D1", b",cm"]) is None
    True
    """

    mapping: FileMapping
    known: Collection[str] = ()
    headless: bool = False

    def find(self, lines: Sequence[bytes]) -> HeadLines | None:
        """The lines above the rows at the beginning of whole lines of a file.

        Args:
            lines: without their ends.

        Returns:
            None where it takes more lines to say.
        """
        # A service starts without what reads files, and needs it with the first line.
        from rga.records.formats.encoding import decoded
        from rga.records.formats.line_protocol import is_line_protocol

        if self.headless:
            return HeadLines(0, None)
        if not lines:
            return None
        logger = "toa5" if _TOA5.match(lines[0]) else self.mapping.logger
        if logger is not None:
            count = HEAD_LINES[logger]
            return HeadLines(count, 1) if len(lines) > count else None
        try:
            text = decoded(b"\n".join(lines), Path(), self.mapping.encoding)
        except InputError:
            # What is wrong with it is told of its rows, when they are read.
            count = self.mapping.head_lines
            return HeadLines(count, count - 1) if len(lines) > count else None
        if is_line_protocol(text.lines()):
            return HeadLines(0, None)
        # The fewest lines that say it: what comes later must not say something else.
        told = text.lines()
        for count in range(1, min(len(told), MOST_LINES) + 1):
            if (found := self._of_these(told[:count])) is not None:
                return found
        return None

    def _of_these(self, lines: Sequence[str]) -> HeadLines | None:
        """What these lines say; None where there is no row among them, or what may be none."""
        from rga.records.formats.shape import find_shape, is_value, split

        known = {"time", *self.known, *self._columns}
        shape = find_shape(lines, self.mapping, known)
        found = HeadLines(shape.data, shape.header)
        if self._is_stated:
            return found if shape.data < len(lines) else None
        rows = 0
        for line in lines[shape.data :]:
            cells = [cell for cell in split(line, shape.delimiter) if cell]
            values = sum(is_value(cell, self.mapping.missing) for cell in cells)
            rows += 2 * values > len(cells)
        names = [] if shape.header is None else split(lines[shape.header], shape.delimiter)
        said = ({one, name_and_unit(one)[0], self.mapping.channel_of(one)[0]} for one in names)
        is_known = any(one & known for one in said)
        return found if rows >= (1 if is_known else UNKNOWN_ROWS) else None

    @property
    def _columns(self) -> set[str]:
        """Columns that the mapping names."""
        named = {one.column for one in self.mapping.channels.values() if one.column}
        return {*named, *self.mapping.unused, *self.mapping.time.columns}

    @property
    def _is_stated(self) -> bool:
        """Whether the mapping says where the lines stand."""
        one = self.mapping
        return bool(one.header_line or one.units_line or one.data_line)

    @property
    def promised(self) -> int:
        """Lines that the mapping says are above the rows; 0: it says nothing of them.

        >>> finders = HeadFinder(FileMapping(header_line=7)), HeadFinder(FileMapping())
        >>> [one.promised for one in finders]
        [7, 0]
        """
        return self.stated if self._is_stated or self.mapping.logger else 0

    @property
    def stated(self) -> int:
        """Lines above the rows, as far as the mapping states them."""
        return 0 if self.headless else self.mapping.head_lines

    def again(self, lines: Sequence[bytes], above: Sequence[bytes], head: HeadLines) -> int | None:
        """How many lines are above the rows where a head comes again.

        Args:
            lines: of the file from there on, without their ends.
            above: those of the head that it had before.
            head: which of them are what.

        Returns:
            None where it takes more lines to say.
        """
        if self._is_stated or self.mapping.logger or _TOA5.match(above[0]):
            count = head.count - (0 if begins_anew(lines[0], above) else head.names or 0)
            rows = (k for k, line in enumerate(lines[:count]) if k and _is_row(line))
            count = next(rows, count)
            return count if len(lines) >= count else None
        found = self.find(lines)
        return None if found is None else max(1, found.count)


def begins_anew(line: bytes, above: Sequence[bytes]) -> bool:
    """Whether a head that comes again does so with its first line, not with that of the names."""
    return _first_cell(line) == _first_cell(above[0])


def completed(again: Sequence[bytes], above: Sequence[bytes], head: HeadLines) -> list[bytes]:
    """A head that came again, with what it lacks of the one before.

    These are the lines above the names, and those below, such as units, in the order of its names.

    Args:
        again: its lines.
        above: those of the head before.
        head: which of them are what.

    >>> before, head = [b"Logger X", b"time,D1,D2", b",cm,mm"], HeadLines(3, 1)
    >>> completed([b"time,D2,D1"], before, head)
    [b'Logger X', b'time,D2,D1', b',mm,cm']
    """
    if head.names is None:
        return [*again]
    first = [] if begins_anew(again[0], above) else [*above[: head.names]]
    found = [*first, *again]
    names, below = above[head.names], above[head.names + 1 : head.count]
    if len(found) != head.names + 1 or not below:
        return found
    known, wanted = _cells(names), _cells(found[-1])
    if any(name_and_unit(one.decode("latin-1"))[1] for one in wanted):
        return found
    sign = _sign(names) or b" "
    for line in below:
        cells = dict(zip(known, _cells(line), strict=False))
        found.append(sign.join(cells.get(one, b"") for one in wanted))
    return found


def beginnings(lines: Sequence[bytes], head: HeadLines) -> re.Pattern[bytes] | None:
    """By what a line is known with which a head comes again; None: by nothing.

    A logger that starts again writes its head again: its first line, or that of the names.

    Args:
        lines: of the head.
        head: which of them are what.

    >>> found = beginnings([b"Logger X", b"time,D1"], HeadLines(2, 1))
    >>> [bool(found.match(one)) for one in (b"time,D2,D1", b"Logger X", b"timer,1", b"2,1")]
    [True, True, False, False]
    """
    if head.names is None:
        return None
    told = {_first_cell(lines[k]) for k in (0, head.names)}
    words = sorted(re.escape(one) for one in told if re.search(rb"[A-Za-z\x80-\xff]", one))
    if not words:
        return None
    return re.compile(
        rb"^(?:" + _MARK + rb")?(?:" + b"|".join(words) + rb")(?=[,;|\s]|\Z)", re.MULTILINE
    )


def _first_cell(line: bytes) -> bytes:
    return next(iter(_cells(line)), b"")


def _sign(line: bytes) -> bytes | None:
    """What parts the cells of a line; None: blanks."""
    found = re.search(rb"[,;\t|]", line)
    return None if found is None else found[0]


def _cells(line: bytes) -> list[bytes]:
    line = line.removeprefix(_MARK)
    return [cell.strip() for cell in line.split(_sign(line))]


def _is_row(line: bytes) -> bool:
    """Whether most cells of a line are numbers, times, or missing."""
    from rga.records.formats.shape import is_value

    cells = [cell.decode("latin-1").strip('"') for cell in _cells(line) if cell]
    return 2 * sum(map(is_value, cells)) > len(cells)
