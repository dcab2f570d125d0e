"""The parts of a page, each worked out by itself: a fault in one is reported in its place."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, ParamSpec, TypeVar

from rga.errors import in_short

P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True)
class Lost:
    """A part that could not be drawn; false, as a part that is not there.

    Attributes:
        words: which part it is, and why.
    """

    words: str

    def __bool__(self) -> Literal[False]:
        return False


def part(name: str, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T | Lost:
    """What a part of a page is, or that it could not be drawn.

    >>> part("The half", lambda x: x / 2, 3.0)
    1.5
    >>> part("The inverse", lambda x: 1 / x, 0.0).words
    'The inverse could not be drawn: ZeroDivisionError: float division by zero.'
    """
    try:
        return work(*args, **kwargs)
    except Exception as error:  # of any kind: the other parts say what they say without this one
        return Lost(f"{name} could not be drawn: {in_short(error)}.")
