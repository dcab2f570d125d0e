"""Files that are read: those of a disk, of a size that fits."""

import os
import stat
from pathlib import Path

from rga.errors import InputError

#: bytes of the largest text that describes something
LARGEST = 64 * 2**20


def bytes_of(
    path: Path, what: str = "file", largest: int = LARGEST, remedy: str = "check the path"
) -> bytes:
    """The content of a file.

    Args:
        path: of it.
        what: it is, as an error calls it.
        largest: number of bytes that it may have.
        remedy: where it cannot be read.

    Raises:
        InputError: it is missing or no file of a disk, cannot be read, or is larger.

    >>> bytes_of(Path("/dev/zero"))
    Traceback (most recent call last):
    rga.errors.InputError: this is no file of a disk (/dev/zero): write what it holds to a file
    """
    try:
        mode = path.stat().st_mode
        ordinary = stat.S_ISREG(mode) or stat.S_ISDIR(mode)
        content = b"" if not ordinary else _first(path, largest + 1)
    # A name that holds a zero byte is none.
    except (OSError, ValueError) as error:
        reason = (getattr(error, "strerror", None) or str(error)).lower()
        raise InputError(f"the {what} cannot be read, {reason}", str(path), remedy) from None
    if not ordinary:
        raise InputError("this is no file of a disk", str(path), "write what it holds to a file")
    if len(content) > largest:
        size = f"more than {largest / 2**20:.0f} MiB"
        raise InputError(f"the {what} has {size}", str(path), "give a smaller one")
    return content


def fault_of(error: Exception) -> str:
    """What is wrong with the text of a file, in words, by the error of its reader.

    >>> fault_of(RecursionError()), fault_of(ValueError("no  table"))
    ('lists or tables stand too deep in one another', 'no table')
    """
    if isinstance(error, RecursionError):
        return "lists or tables stand too deep in one another"
    return " ".join(str(error).split()) or type(error).__name__


def _first(path: Path, count: int) -> bytes:
    """At most so many bytes; room is made for those that are there."""
    with path.open("rb") as file:
        return file.read(min(count, os.fstat(file.fileno()).st_size + 1))
