"""Text of a logger's file as UTF-8, whatever its encoding."""

import codecs
from dataclasses import dataclass
from pathlib import Path

from rga.errors import InputError

_MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF32_LE: "utf-32-le",
    codecs.BOM_UTF32_BE: "utf-32-be",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
#: first bytes of files that are no text, and what they are
_NO_TEXT = {
    b"PK\x03\x04": "a ZIP archive or a workbook (.xlsx): save the sheet as CSV",
    b"\x89HDF": "HDF5, as MATLAB's v7.3: save it with '-v7', or export it as CSV or Parquet",
    b"\x1f\x8b": "gzip: unpack it",
    b"%PDF": "a PDF: export the numbers as CSV",
    b"\xd0\xcf\x11\xe0": "an old Excel workbook (.xls): save the sheet as CSV",
    b"SQLite format 3": "an SQLite database: export the table as CSV",
    b"TOB": "a binary file of a Campbell Scientific logger (TOB): convert it to TOA5",
    b"7z\xbc\xaf": "a 7z archive: unpack it",
    b"{\\rtf": "a document (RTF): export the numbers as CSV",
    b"<?xml": "XML: export the numbers as CSV",
    b"<!DOCTYPE": "a web page: fetch the file itself",
    b"<html": "a web page: fetch the file itself",
    b"\x89PNG": "a picture",
    b"\xff\xd8\xff": "a picture",
}
REPLACED = "\ufffd"
_LOOKED_AT = 1 << 16
_HIGH = bytes(range(128, 256))


@dataclass(frozen=True)
class Text:
    """Text of a file.

    Attributes:
        path: the file.
        data: UTF-8 without a mark at its head; lines end with a line feed.
        notes, warnings: what was understood of it, and what is wrong with it, in words.
    """

    path: Path
    data: bytes
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def lines(self, most: int | None = None) -> list[str]:
        """Its lines, or those that its head has."""
        data = self.data
        if most is not None and len(data) > most:
            data = data[: data.rfind(b"\n", 0, most) + 1 or most]
        lines = data.decode("utf-8", "replace").split("\n")
        return lines[:-1] if lines[-1] == "" else lines

    def below(self, line: int) -> bytes:
        """The text from a line on, counted from 0."""
        place = 0
        for _ in range(line):
            place = self.data.find(b"\n", place) + 1
            if place == 0:
                return b""
        return self.data[place:]


def decoded(data: bytes, path: Path, encoding: str | None = None) -> Text:
    r"""The text of a file.

    Args:
        data: its bytes.
        path: the file, for an error.
        encoding: where it is stated; None: found from the bytes.

    Raises:
        InputError: it is no text, or not in the encoding stated.

    >>> decoded(b"L\xe4nge [\xb5m/m]", Path("r.csv")).lines()
    ['Länge [µm/m]']
    """
    notes: tuple[str, ...] = ()
    if encoding is None:
        _refuse_known(data, path)
        encoding = _marked_or_unmarked(data)
        if encoding is None:
            encoding, notes = _single_bytes(data)
    mark = next((mark for mark in _MARKS if data.startswith(mark)), b"")
    if mark and codecs.lookup(_MARKS[mark]) == codecs.lookup(encoding):
        data = data.removeprefix(mark)
    damaged = "replace" if encoding == "utf-8" and notes else "strict"
    try:
        text = data.decode(encoding, damaged)
    except (UnicodeDecodeError, UnicodeError) as error:
        start = error.start if isinstance(error, UnicodeDecodeError) else len(data)
        line = data.count(b"\n", 0, start) + 1
        raise InputError(
            f"the text is not {encoding.upper()} throughout",
            f"{path}, line {line}",
            "state its encoding in import.toml, or save it as UTF-8",
        ) from None
    _refuse_controls(text, path)
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Text(path, text.encode("utf-8", "replace"), notes, _damage(text))


def _refuse_known(data: bytes, path: Path) -> None:
    head = data[:64].lstrip()
    for first, kind in _NO_TEXT.items():
        if head.startswith(first) and not (first == b"TOB" and data[:4] == b"TOB,"):
            raise InputError("this is no table of text", str(path), f"it is {kind}")


def _marked_or_unmarked(data: bytes) -> str | None:
    """UTF-8, UTF-16 or UTF-32 where the bytes say so; None: they are none of these."""
    for mark, encoding in _MARKS.items():
        if data.startswith(mark):
            return encoding
    head = data[:_LOOKED_AT]
    for encoding, zeros in (("utf-16-le", head[1::2]), ("utf-16-be", head[::2])):
        if head.count(0) and zeros.count(0) > 0.4 * len(zeros):
            return encoding
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return None
    return "utf-8"


def _single_bytes(data: bytes) -> tuple[str, tuple[str, ...]]:
    """Encoding of a text that is not UTF-8, and a note that says so."""
    read = data.decode("utf-8", "replace")
    broken = read.count(REPLACED)
    high = len(data) - len(data.translate(None, _HIGH))
    # A letter beyond ASCII has two bytes or more in UTF-8.
    whole = (high - broken) // 2
    if whole >= broken:
        return "utf-8", ("the text is UTF-8 with bytes that are not",)
    try:
        text, encoding = data.decode("cp1252"), "cp1252"
    except UnicodeDecodeError:
        text, encoding = data.decode("latin-1"), "latin-1"
    line, number = next(
        (one.strip(), number) for number, one in enumerate(text.split("\n"), 1) if not one.isascii()
    )
    note = f"the text is not UTF-8 and was read as {encoding}: {line[:40]!r}, line {number}"
    return encoding, (f"{note}; state encoding in import.toml if that is wrong",)


def _refuse_controls(text: str, path: Path) -> None:
    head = text[:_LOOKED_AT]
    controls = sum(one < " " and one not in "\t\n\r\f\x1a\x00" for one in head)
    if "\x00" in head or controls > max(3, 0.01 * len(head)):
        raise InputError(
            "this is no table of text but of bytes",
            str(path),
            "export it as text, CSV or Parquet with the software of the logger",
        )


def _damage(text: str) -> tuple[str, ...]:
    """In words, that characters were lost before the file came here."""
    if REPLACED not in text:
        return ()
    numbers = [n for n, line in enumerate(text.split("\n"), 1) if REPLACED in line]
    shown = ", ".join(str(number) for number in numbers[:5])
    more = f" and {len(numbers) - 5} more" if len(numbers) > 5 else ""
    plural = "s" if len(numbers) > 1 else ""
    return (f"characters are damaged in line{plural} {shown}{more}: they are left as they are",)
