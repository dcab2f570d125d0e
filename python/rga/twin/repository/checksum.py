"""Proof that what is read is what was written: a checksum of every entry."""

from collections.abc import Mapping
from functools import lru_cache
from numbers import Real
from struct import Struct
from typing import Any
from zlib import crc32

#: name of its column
COLUMN = "checksum"
_DOUBLE = Struct("<d")


def checksum(values: Mapping[str, Any]) -> int:
    """The CRC-32 of the columns of an entry, whatever their order; its own column is left out.

    Args:
        values: by column: a number, a text, bytes or nothing each.

    Raises:
        TypeError: a value is of another kind.

    >>> checksum({"row": 3, "words": "an alarm"}) == checksum({"words": "an alarm", "row": 3.0})
    True
    >>> checksum({"row": 3, "words": "an alarm"}) == checksum({"row": 3, "words": "an alarn"})
    False
    """
    parts: list[bytes] = []
    for name in sorted(values):
        if name != COLUMN:
            content = _content(values[name])
            parts += _heading(name, len(content)), content
    return crc32(b"".join(parts))


def with_checksum(**columns: Any) -> dict[str, Any]:
    """An entry to be written."""
    return columns | {COLUMN: checksum(columns)}


def is_whole(values: Mapping[str, Any]) -> bool:
    """Whether an entry holds what was written.

    >>> entry = {"row": 3, "words": None}
    >>> is_whole(with_checksum(**entry)), is_whole(entry | {"checksum": 1})
    (True, False)
    """
    try:
        return bool(checksum(values) == values[COLUMN])
    except (TypeError, OverflowError):
        # A damaged file may hold another kind of value than its column is of.
        return False


@lru_cache(maxsize=4096)
def _heading(name: str, length: int) -> bytes:
    # The length keeps what ends one column from passing to the next.
    return f"{name} {length} ".encode()


def _content(value: Any) -> bytes:
    # The plain ones first: asking whether one is a Real takes long.
    if isinstance(value, bytes):
        return b"bytes" + bytes(value)
    if isinstance(value, str):
        return b"text" + value.encode("utf-8", "surrogatepass")
    # SQLite keeps no NaN, and no sign of a zero.
    if value is None or value != value:
        return b"nothing"
    if type(value) in (int, float) or isinstance(value, Real):
        return b"number" + _DOUBLE.pack(float(value) + 0.0)
    return b"bytes" + bytes(memoryview(value))
