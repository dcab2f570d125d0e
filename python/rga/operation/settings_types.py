"""Kinds of values in the file of a service."""

import re
from collections.abc import Mapping
from typing import Annotated, Any
from unicodedata import category

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

_SIZES = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86_400.0}
_SPANS = {"hour": 3600.0, "day": 86_400.0}
_YEAR = 365.25 * 86_400.0
_LONG_SPANS = _SPANS | {
    "week": 7 * 86_400.0,
    "month": _YEAR / 12,
    "quarter": _YEAR / 4,
    "year": _YEAR,
}
_RATE = re.compile(r"([1-9]\d{0,5}) an? ([a-z]+)")
_DURATION = re.compile(rf"(\d+(?:\.\d+)?) ?({'|'.join(_SIZES)})")


def duration_of(given: Any) -> float:
    """Seconds of a duration, as people write it.

    Raises:
        ValueError: it is none.

    >>> duration_of("10 min"), duration_of("0.5 s")
    (600.0, 0.5)
    """
    found = _DURATION.fullmatch(given) if isinstance(given, str) else None
    if found is None:
        raise ValueError(f"{given!r} is no duration: write '60 s', '10 min', '2 h' or '7 d'")
    return float(found[1]) * _SIZES[found[2]]


Duration = Annotated[float, BeforeValidator(duration_of), Field(gt=0, le=366 * 86_400)]
#: how long something is before it counts, perhaps not at all [s]
Wait = Annotated[float, BeforeValidator(duration_of), Field(ge=0, le=366 * 86_400)]


def rate_of(given: Any) -> tuple[int, float]:
    """How many within how many seconds a rate is, as people write it.

    Raises:
        ValueError: it is none.

    >>> rate_of("12 an hour"), rate_of("5 a day")
    ((12, 3600.0), (5, 86400.0))
    """
    return _rate(given, _SPANS, "'12 an hour' or '20 a day'")


def rarity_of(given: Any) -> tuple[int, float]:
    """The same of what is rare.

    Raises:
        ValueError: it is none.

    >>> rarity_of("1 a quarter")
    (1, 7889400.0)
    """
    return _rate(given, _LONG_SPANS, "'1 a quarter' or '2 a year'")


def _rate(given: Any, spans: Mapping[str, float], examples: str) -> tuple[int, float]:
    found = _RATE.fullmatch(given) if isinstance(given, str) else None
    if found is None or found[2] not in spans:
        raise ValueError(f"{given!r} is no rate: write {examples}")
    return int(found[1]), spans[found[2]]


Rate = Annotated[tuple[int, float], BeforeValidator(rate_of)]
Rarity = Annotated[tuple[int, float], BeforeValidator(rarity_of)]
#: as it stands in addresses, topics and names of folders
NAME_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$"
Name = Annotated[str, Field(pattern=NAME_PATTERN)]


class SettingsTable(BaseModel):
    """A table of the file: a key that is not known is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def is_readable(text: str) -> bool:
    """Whether words have no character that nobody sees, such as NUL; they may have several lines.

    >>> is_readable("first line\\nsecond"), is_readable("a\\0b")
    (True, False)
    """
    return not any(category(one) in ("Cc", "Cs") and one not in "\t\n\r" for one in text)
