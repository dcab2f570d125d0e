"""What follows the search: findings stand without it where it fails."""

from collections.abc import Callable
from typing import TypeVar

from rga.errors import in_short

T = TypeVar("T")


def spared(what: str, work: Callable[[], T], otherwise: T, warnings: list[str]) -> T:
    """What some work gives; where its numbers fail, something else and a warning.

    Args:
        what: is worked out, in words.
        work: that the findings can do without.
        otherwise: is given in its stead.
        warnings: to which the failure is added.
    """
    try:
        return work()
    # Singular matrices, values that are not finite, and structures that cannot be simulated.
    except (ArithmeticError, ValueError) as error:
        warnings.append(f"{what} could not be worked out: {in_short(error)}")
        return otherwise
