"""How far off a sensor is: a step of a scale, in a word as well as in a colour."""

from dataclasses import dataclass
from math import isfinite


@dataclass(frozen=True)
class GapLevel:
    """A step of the scale of gaps.

    Attributes:
        number: from 0, as noise lets expect; -1: there is no gap to tell.
        words: what it says of a sensor.
        below: gap at which the next step begins [-]; None: there is no next.
    """

    number: int
    words: str
    below: float | None

    @property
    def style(self) -> str:
        """Name of the step in the style sheet."""
        return f"gap{self.number}" if self.number >= 0 else "gap-none"


#: steps that eyes tell apart; the gap of noise alone is 1
LEVELS = (
    GapLevel(0, "as noise", 2.0),
    GapLevel(1, "slightly off", 5.0),
    GapLevel(2, "off", 20.0),
    GapLevel(3, "far off", 100.0),
    GapLevel(4, "very far off", None),
)
UNKNOWN = GapLevel(-1, "no value", None)
#: of a sensor that is not watched
OUT_OF_USE = GapLevel(-1, "out of use", None)


def gap_level(gap: float | None) -> GapLevel:
    """The step of a gap [-], by the two digits of it that are shown.

    >>> gap_level(1.2).words, gap_level(130.0).words, gap_level(None).words
    ('as noise', 'very far off', 'no value')
    >>> gap_level(19.4).words, gap_level(19.6).words
    ('off', 'far off')
    """
    if gap is None or not isfinite(gap):
        return UNKNOWN
    shown = float(f"{gap:.2g}")
    return next(one for one in LEVELS if one.below is None or shown < one.below)
