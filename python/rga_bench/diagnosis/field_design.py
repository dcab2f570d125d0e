"""The design of the challenge on the second generator: the same draws of other cases.

Circumstances go round with the kinds: reality pinned or welded, plain, zeroed by its logger, or
with a broken channel; outages and a coarse logger come with any of them.
"""

from dataclasses import dataclass
from typing import NamedTuple

from rga_bench.diagnosis.design import AIMS, Draw
from rga_bench.field import INSIDE, OUTSIDE, STRUCTURES, Options, draw_field, fits
from rga_bench.synthetic import Case

#: what the names of its cases begin with
PREFIX = "field-"
#: share of the records with outages, and of those from a coarse logger
_GAPS, _COARSE = 0.3, 0.3


class FieldCircumstance(NamedTuple):
    """What a case is recorded under: the null record that its twin is, and how."""

    null: str
    welded: bool
    tared: bool = False
    broken: bool = False


FIELD_CIRCUMSTANCES = (
    FieldCircumstance("pinned", False),
    FieldCircumstance("welded", True),
    FieldCircumstance("pinned, tared", False, tared=True),
    FieldCircumstance("welded, a channel broken", True, broken=True),
    FieldCircumstance("pinned, a channel broken", False, broken=True),
    FieldCircumstance("welded, tared", True, tared=True),
    FieldCircumstance("pinned, tared, a channel broken", False, tared=True, broken=True),
)
FIELD_NULLS = tuple(one.null for one in FIELD_CIRCUMSTANCES)


@dataclass(frozen=True)
class FieldDraw(Draw):
    """One case of the challenge on the second generator.

    >>> draw_of("field-7-single-12-null")
    FieldDraw(seed=7, stratum='single', number=12, null=True)
    """

    prefix = PREFIX

    @property
    def recorded(self) -> FieldCircumstance:
        """What the case is recorded under."""
        return FIELD_CIRCUMSTANCES[self.number % len(FIELD_CIRCUMSTANCES)]

    @property
    def null_name(self) -> str:
        """Name of the null record that its twin is."""
        return self.recorded.null

    @property
    def contexts(self) -> str:
        """How its contexts are known."""
        return "measured"

    @property
    def kinds(self) -> tuple[str, ...]:
        """What is hidden in the draw, and not in its twin."""
        inside, outside = list(INSIDE), list(OUTSIDE)
        if self.stratum == "outside":
            return (outside[self.number % len(outside)],)
        if self.stratum == "single":
            return (inside[self.number % len(inside)],)
        rng = self.random("kinds")
        while True:
            first, second = (inside[k] for k in rng.choice(len(inside), 2, replace=False))
            if _structures((first, second)):
                return first, second

    @property
    def bridge(self) -> str:
        """The structure that it stands on."""
        several = _structures(self.kinds)
        return several[int(self.random("structure").integers(len(several)))]

    def case(self) -> Case:
        """The case itself."""
        rng = self.random("case")
        seed, aims = int(rng.integers(2**31)), AIMS[self.stratum]
        gaps, coarse = (float(x) for x in rng.random(2))
        recorded = self.recorded
        return draw_field(
            seed,
            structure=self.bridge,
            kind="null" if self.null else self.kinds,
            welded=recorded.welded,
            options=Options(recorded.tared, gaps < _GAPS, coarse < _COARSE, recorded.broken),
            aims=aims[int(rng.integers(3)) % len(aims)],
        )


#: generators of cases, by the value of `--generator`
GENERATORS: dict[str, type[Draw]] = {"bridges": Draw, "field": FieldDraw}


def draw_of(name: str) -> Draw:
    """The draw of a name, of either generator (InputError)."""
    if name.startswith(PREFIX):
        return FieldDraw.parse(name)
    return Draw.parse(name)


def _structures(kinds: tuple[str, ...]) -> list[str]:
    """The structures that have what all of the kinds act on."""
    return [name for name in STRUCTURES if all(fits(kind, name) for kind in kinds)]
