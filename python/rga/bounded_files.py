"""Files that are read: those of a disk, of a size that fits."""

import os
import re
import stat
import tomllib
from pathlib import Path
from typing import Any

from rga.errors import InputError
from rga.inputs import remember

#: bytes of the largest text that describes something
LARGEST = 64 * 2**20
#: tables within tables that a key of TOML may name: its reader takes the square of them
DEEPEST = 100
_DEEP_KEY = re.compile(rf"(?<![\w\"'-])(?:[\w\"'-]++[ \t]*+\.[ \t]*+){{{DEEPEST}}}")
#: digits of an integer, of which no more than some thousands can be shown
_LONG_INTEGER = re.compile(r"\b0[xob][\w]{300}")


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
        remember(path)
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


def toml_of(text: str) -> dict[str, Any]:
    """What a text in TOML holds.

    Raises:
        ValueError: it is no TOML, or has keys or integers beyond all bounds.
        RecursionError: values stand too deep in one another.

    >>> toml_of("a.b = 1")
    {'a': {'b': 1}}
    >>> toml_of("a" + ".a" * 40_000 + " = 1")
    Traceback (most recent call last):
    ValueError: a key names more than 100 tables within tables
    """
    if _DEEP_KEY.search(text):
        raise ValueError(f"a key names more than {DEEPEST} tables within tables")
    if _LONG_INTEGER.search(text):
        raise ValueError("an integer has more than 300 digits")
    return tomllib.loads(text)


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
