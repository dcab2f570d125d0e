"""Text files of other programs, read within bounds."""

from pathlib import Path

from rga.bounded_files import bytes_of
from rga.errors import InputError


def read_bytes(path: Path) -> bytes:
    """The bytes of a file.

    Raises:
        InputError: it is missing, empty, a folder, or larger than any model of a structure.
    """
    if path.is_dir():
        raise InputError("this is a folder", str(path), "name a file")
    data = bytes_of(path)
    if not data.strip():
        raise InputError("the file is empty", str(path), "give the whole file")
    return data


def read_text(path: Path) -> str:
    """The text of a file in UTF-8, UTF-16 with its mark, or else Windows-1252.

    Raises:
        InputError: as of `read_bytes`, or the file is no text.
    """
    data = read_bytes(path)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16", errors="replace")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("cp1252", errors="replace")
    if place := next((place for place, sign in enumerate(text) if sign == "\0"), -1) + 1:
        line = text.count("\n", 0, place) + 1
        raise InputError("this is no text", f"{path}, line {line}", "give the file as text")
    return text.replace("\r\n", "\n").replace("\r", "\n")
