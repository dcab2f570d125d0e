"""Numbers as Tcl writes and reads them."""

import re

from rga.errors import InputError

INTEGER = re.compile(r"\s*[-+]?(\d+|0[xX][0-9a-fA-F]+)\s*$", re.ASCII)
FLOATING = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*$", re.ASCII)

Number = int | float


def number(text: str, where: str) -> Number:
    """The number that a text is.

    Raises:
        InputError: it is none, or one with leading zeros, which Tcl 8 takes for octal.
    """
    if INTEGER.match(text):
        stripped = text.strip()
        digits = stripped.lstrip("+-")
        if digits[:2].lower() == "0x":
            return int(stripped, 16)
        if len(digits) > 1 and digits[0] == "0":
            raise InputError(
                f"{stripped} is octal in Tcl 8 and decimal in Tcl 9",
                where,
                "write it without zeros",
            )
        return int(stripped)
    if FLOATING.match(text):
        return float(text)
    raise InputError(f"{text.strip()[:40]!r} is no number", where, "write a number")


def is_number(text: str) -> bool:
    """Whether a text is a number."""
    return bool(INTEGER.match(text) or FLOATING.match(text))


def written(value: Number | bool) -> str:
    """A number as Tcl writes it: the shortest text that reads the same.

    >>> written(2.0), written(1e-10), written(True)
    ('2.0', '1e-10', '1')
    """
    return repr(int(value) if isinstance(value, bool) else value)
