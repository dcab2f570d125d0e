"""Rows of a table of text as columns of stripped cells."""

import re
from collections.abc import Sequence
from pathlib import Path

import polars as pl

from rga.errors import InputError

#: columns beyond which a file is no table of channels
MOST_COLUMNS = 20_000


def read_rows(
    body: bytes,
    delimiter: str,
    names: Sequence[str],
    path: Path,
    first: int,
    header: int | None = None,
    *,
    ragged: bool = False,
) -> tuple[pl.DataFrame, tuple[int, ...]]:
    """Rows as columns of text, null where a cell is empty; and the blank lines between them.

    A blank line is no row, unless there is but one column, whose value may be missing.

    Args:
        body: the rows, UTF-8 with line feeds.
        delimiter: between cells; a blank: runs of white space.
        names: of the columns; an empty one for a column that must be empty.
        path: the file, for an error.
        first: line of the file at which the rows begin, counted from 0.
        header: line of the names, counted from 0.
        ragged: rows may leave out cells at their end.

    Returns:
        The columns, and the lines of the file that were passed over, counted from 1.

    Raises:
        InputError: a row has more or fewer cells than there are names, or a quote does not end.
    """
    body = body.rstrip(b"\n\x1a\x00 ")
    if not body:
        return pl.DataFrame(schema=dict.fromkeys(filter(None, names), pl.String)), ()
    if delimiter == " ":
        body = re.sub(rb"[ \t]+", b"\t", re.sub(rb"(?m)^[ \t]+|[ \t]+$", b"", body))
        delimiter = "\t"
    if b"\x01" in body:
        line = body.count(b"\n", 0, body.index(b"\x01")) + first + 1
        raise InputError(
            "the line holds bytes that are no text", f"{path}, line {line}", "take them out"
        )
    quoted = b'"' in body
    count = len(names)
    lengths = _lengths(body, delimiter, quoted, path, first)
    most = int(lengths.max() or 0)  # type: ignore[arg-type]
    wide = max(count, most)
    if most > 10 * count + 1000:
        raise InputError(
            f"a line has {most} fields, the header has {count}", str(path), "mend the line"
        )
    if wide > MOST_COLUMNS:
        what = f"a line has {wide} fields, and at most {MOST_COLUMNS} are read"
        raise InputError(what, str(path), "part the table, a column a channel")
    ids = [f"c{number}" for number in range(wide)]
    head = delimiter.join(ids).encode() + b"\n"
    try:
        frame = pl.read_csv(
            head + body,
            separator=delimiter,
            infer_schema=False,
            quote_char='"' if quoted else None,
        )
    except pl.exceptions.PolarsError as error:
        problem = next(iter(str(error).splitlines()), type(error).__name__)
        raise InputError(f"the table cannot be read: {problem}", str(path), "mend it") from None
    for column in frame.columns:  # one by one, so that there are never two of all
        cells = pl.col(column).str.strip_chars(" \t\u00a0")
        frame = frame.with_columns(pl.when(cells != "").then(cells).alias(column))
    _check(frame, lengths, names, path, first, header, ragged=ragged)
    kept = [one for one, name in zip(ids, names, strict=False) if name]
    frame = frame.select(kept).rename(dict(zip(kept, [n for n in names if n], strict=True)))
    filled = frame.select(pl.any_horizontal(pl.all().is_not_null())).to_series().arg_true()
    frame = frame.head(int(filled[-1]) + 1 if len(filled) else 0)  # files may end with blank lines
    blank = lengths.head(frame.height) == 0
    if count < 2 or not blank.any():
        return frame, ()
    return frame.filter(~blank), tuple((blank.arg_true() + first + 1).to_list())


def _lengths(body: bytes, delimiter: str, quoted: bool, path: Path, first: int) -> pl.Series:
    """How many cells every line has, int[lines]; 0 if it is blank."""
    lines = pl.read_csv(b"line\n" + body, separator="\x01", quote_char=None, infer_schema=False)[
        "line"
    ].fill_null("")
    if quoted:
        opened = (lines.str.count_matches('"', literal=True) % 2 != 0).arg_true()
        if len(opened):
            raise open_quote(path, first + int(opened[0]))
        lines = lines.str.replace_all('"[^"]*"', "q")
    counts = lines.str.count_matches(delimiter, literal=True).cast(pl.Int64) + 1
    blank = lines.str.strip_chars() == ""
    return pl.select(pl.when(blank).then(0).otherwise(counts)).to_series()


def _check(
    frame: pl.DataFrame,
    lengths: pl.Series,
    names: Sequence[str],
    path: Path,
    first: int,
    header: int | None,
    *,
    ragged: bool,
) -> None:
    """Refuses rows with fewer cells than names, or unlike the rest, and values without a name."""
    count = len(names)
    for number, column in enumerate(frame.columns):
        has_name = number < count and names[number]
        if has_name or frame[column].is_null().all():
            continue
        row = int(frame[column].is_not_null().arg_true()[0])
        if number < count and header is not None:
            raise InputError(
                f"column {number + 1} has no name", f"{path}, line {header + 1}", "name it"
            )
        raise _other_length(int(lengths[row]), count, path, first + row)
    if ragged:
        return
    # Rows may all end with a delimiter, or lack what has no name.
    usual = lengths.filter(lengths > 0).mode().max() if (lengths > 0).any() else count
    named = max((k for k, name in enumerate(names, start=1) if name), default=0)
    odd = (((lengths != usual) | (lengths < named)) & (lengths > 0)).arg_true()
    if len(odd):
        row = int(odd[0])
        raise _other_length(int(lengths[row]), count, path, first + row)


def open_quote(path: Path, line: int) -> InputError:
    """The error of a line, counted from 0, in which a quote begins and does not end."""
    return InputError(
        "a quote begins in the line and does not end there",
        f"{path}, line {line + 1}",
        "write the cell in one line, and in two quotes or in none",
    )


def _other_length(length: int, count: int, path: Path, line: int) -> InputError:
    return InputError(
        f"the line has {length} fields, the header has {count}",
        f"{path}, line {line + 1}",
        "write all fields of the line, empty ones where values are missing",
    )
