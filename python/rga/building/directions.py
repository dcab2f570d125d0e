"""Directions in global axes, in words."""

from collections.abc import Sequence
from typing import Any

from rga.building.quantities import amounts
from rga.errors import InputError

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
WORDS: dict[str, tuple[float, float, float]] = {
    **_AXES,
    **{f"-{axis}": (-x, -y, -z) for axis, (x, y, z) in _AXES.items()},
    "up": _AXES["z"],
    "down": (0.0, 0.0, -1.0),
}

#: a word of `WORDS`, or three components
Direction = str | Sequence[float]


def direction(given: Direction | Any, where: str) -> list[float]:
    """Three components of a direction.

    Raises:
        InputError: a word that is none, or components that point nowhere.

    >>> direction("down", "sensor"), direction((1, 0, 1), "sensor")
    ([0.0, 0.0, -1.0], [1.0, 0.0, 1.0])
    """
    if isinstance(given, str):
        if given not in WORDS:
            raise InputError(f"{given!r} is no direction", where, "use " + ", ".join(WORDS))
        # No minus sign before a zero.
        return [part + 0.0 for part in WORDS[given]]
    components = amounts(given, "", where, 3)
    if not any(components):
        raise InputError("the direction [0, 0, 0] points nowhere", where, "give another")
    return components
