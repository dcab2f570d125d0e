"""Kinds of values in the file of a service."""

import re
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

_SIZES = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86_400.0}
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
#: as it stands in addresses, topics and names of folders
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$")]


class SettingsTable(BaseModel):
    """A table of the file: a key that is not known is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)
