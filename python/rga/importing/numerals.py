"""Numbers from the texts of files."""

from typing import Any

from rga.quantities import plain


def float_of(value: Any) -> float:
    """A text, or a number of any kind, as a number.

    Raises:
        ValueError: it is none, or larger than any number of Python.

    >>> float_of(" -2.5e3"), float_of(7)
    (-2500.0, 7.0)
    >>> float_of("3_0")
    Traceback (most recent call last):
    ValueError: '3_0' is no number
    """
    try:
        return float(plain(value.strip()) if isinstance(value, str) else value)
    except (OverflowError, TypeError, ValueError):
        raise ValueError(f"{value!r} is no number") from None
