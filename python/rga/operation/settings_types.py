"""Kinds of values in the file of a service."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any
from unicodedata import category

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

_SIZES = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86_400.0}
_SPANS = {"hour": 3600.0, "day": 86_400.0}
_YEAR = 365.25 * 86_400.0
_LONG_SPANS = _SPANS | {
    "week": 7 * 86_400.0,
    "month": _YEAR / 12,
    "quarter": _YEAR / 4,
    "year": _YEAR,
}
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


@dataclass(frozen=True)
class Lasting:
    """Durations [s] that are written in words, no shorter and no longer than others.

    Attributes:
        least, most: in words.
        examples: for those who write one.

    Example: `Annotated[float, Lasting(least="7 d")]`.
    """

    least: str = "1 ms"
    most: str = "366 d"
    examples: tuple[str, ...] = ("60 s", "10 min", "2 h", "7 d")

    def seconds(self, given: Any) -> float:
        """Seconds of a duration.

        Raises:
            ValueError: it is none, or is too short or too long.

        >>> Lasting(least="7 d").seconds("1 d")
        Traceback (most recent call last):
        ValueError: it is 1 d, and at least 7 d is needed
        """
        found = duration_of(given)
        if found < duration_of(self.least):
            raise ValueError(f"it is {given}, and at least {self.least} is needed")
        if found > duration_of(self.most):
            raise ValueError(f"it is {given}, and at most {self.most} is possible")
        return found

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self.seconds,
            serialization=core_schema.plain_serializer_function_ser_schema(
                in_words, when_used="json"
            ),
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        limits = f"at least {self.least}, at most {self.most}"
        return _text(_DURATION.pattern, self.examples) | {"description": limits}


def in_words(seconds: float) -> str:
    """A duration in the largest unit in which it is a whole number.

    >>> in_words(600.0), in_words(90.0), in_words(0.0)
    ('10 min', '90 s', '0 s')
    """
    whole = [unit for unit, size in _SIZES.items() if seconds >= size and seconds % size == 0]
    unit = whole[-1] if whole else "s"
    return f"{seconds / _SIZES[unit]:.12g} {unit}"


Duration = Annotated[float, Lasting()]
#: how long something is before it counts, perhaps not at all [s]
Wait = Annotated[float, Lasting(least="0 s")]


@dataclass(frozen=True, eq=False)
class _Often:
    """Rates that are written in words: how many within how many seconds.

    Attributes:
        spans: by name [s].
        examples: two, for those who write one.
    """

    spans: Mapping[str, float]
    examples: tuple[str, str]

    @property
    def pattern(self) -> str:
        """Of the words."""
        return rf"([1-9]\d{{0,5}}) an? ({'|'.join(self.spans)})"

    def read(self, given: Any) -> tuple[int, float]:
        """How many within how many seconds a rate is.

        Raises:
            ValueError: it is none.
        """
        found = re.fullmatch(self.pattern, given) if isinstance(given, str) else None
        if found is None:
            first, second = self.examples
            raise ValueError(f"{given!r} is no rate: write {first!r} or {second!r}")
        return int(found[1]), self.spans[found[2]]

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return _text(self.pattern, self.examples)


_RATE = _Often(_SPANS, ("12 an hour", "20 a day"))
_RARITY = _Often(_LONG_SPANS, ("1 a quarter", "2 a year"))
Rate = Annotated[tuple[int, float], _RATE]
#: the same of what is rare
Rarity = Annotated[tuple[int, float], _RARITY]
#: as it stands in addresses, topics and names of folders
NAME_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$"
Name = Annotated[str, Field(pattern=NAME_PATTERN)]


class SettingsTable(BaseModel):
    """A table of the file: a key that is not known is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _text(pattern: str, examples: Sequence[str]) -> JsonSchemaValue:
    """How JSON Schema says that something is written in words."""
    return {"type": "string", "pattern": f"^{pattern}$", "examples": list(examples)}


def is_readable(text: str) -> bool:
    """Whether words have no character that nobody sees, such as NUL; they may have several lines.

    >>> is_readable("first line\\nsecond"), is_readable("a\\0b")
    (True, False)
    """
    return not any(category(one) in ("Cc", "Cs") and one not in "\t\n\r" for one in text)
