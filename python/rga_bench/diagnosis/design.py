"""The design of the blind challenge: which cases are drawn, by seed, stratum and number.

A draw is a pure function of these three, and stands beside its null twin: the same bridge,
contexts and noise with nothing hidden. Kinds go round in turn, and so do circumstances; their
numbers have no common divisor, so every kind meets every circumstance.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from rga_bench.diagnosis.blind_draw import BlindDraw
from rga_bench.synthetic import BRIDGES, KINDS, Case, Conditions, draw_case
from rga_bench.synthetic.hidden.catalogue import fits

#: hidden draws of a quick challenge; as many null twins stand beside them
QUICK = 8
#: share of the draws in each stratum
STRATA = {"single": 0.6, "pair": 0.2, "outside": 0.2}
#: kinds outside every vocabulary; the first has three forms
OUTSIDE = ("unknown", "unknown", "unknown", "hysteresis")
SINGLES = tuple(kind for kind in KINDS if kind not in ("null", *OUTSIDE))
#: bounds of the d' that is aimed at; the second pair of `single` for one draw in three
AIMS = {"single": ((12.0, 60.0), (6.0, 14.0)), "pair": ((22.0, 45.0),), "outside": ((25.0, 80.0),)}
#: kinds of which a bridge has one at a time
AT_MOST_ONE = ("bearing_friction", "joint_slip", "support_gap")
#: rows after the record, and share of the sensors, that the diagnosis does not get
LATER, UNSEEN = 60, 0.2
SLIGHT = 0.01


class Circumstance(NamedTuple):
    """What a case is recorded under: the null record that its twin is, and how."""

    null: str
    conditions: Conditions
    stiff: bool = False


def _circumstances() -> tuple[Circumstance, ...]:
    usual = Conditions(scatter=SLIGHT, ramps=True, later=LATER, unseen=UNSEEN)
    noises = {
        "white": replace(usual, noise="white"),
        "AR(1) 0.6": replace(usual, noise="long memory"),
        "Student t3": replace(usual, noise="heavy tails"),
        "3 % scatter": replace(usual, scatter=0.03),
    }
    several = [
        Circumstance(name, replace(noise, contexts="known")) for name, noise in noises.items()
    ]
    several += [Circumstance(name, noise) for name, noise in noises.items()]
    several += [
        Circumstance(name, replace(noise, contexts="latent")) for name, noise in noises.items()
    ]
    for sampling in ("even", "gaps", "uneven"):
        own = replace(usual, sampling=sampling, scatter=None)
        several.append(Circumstance("contexts off", replace(own, contexts="off")))
        several.append(Circumstance("frame", own, stiff=True))
    # Like ones apart, so that a part of the challenge has them all.
    return tuple(several[5 * k % len(several)] for k in range(len(several)))


CIRCUMSTANCES = _circumstances()
NULLS = tuple(dict.fromkeys(one.null for one in CIRCUMSTANCES))


@dataclass(frozen=True)
class Draw(BlindDraw):
    """One case of the challenge.

    >>> Draw.parse("7-single-12-null")
    Draw(seed=7, stratum='single', number=12, null=True)
    """

    strata = STRATA

    @property
    def circumstance(self) -> Circumstance:
        """What the case is recorded under."""
        number = self.number
        chosen = CIRCUMSTANCES[number % len(CIRCUMSTANCES)]
        while chosen.stiff and "joint_rigidity" in self.kinds:
            # Stiff joints are then what is hidden, not what is hidden beside.
            number += 1
            chosen = CIRCUMSTANCES[number % len(CIRCUMSTANCES)]
        return chosen

    @property
    def null_name(self) -> str:
        """Name of the null record that its twin is."""
        return self.circumstance.null

    @property
    def contexts(self) -> str:
        """How its contexts are known: known, measured, off, latent."""
        return self.circumstance.conditions.contexts

    @property
    def kinds(self) -> tuple[str, ...]:
        """What is hidden in the draw, and not in its twin."""
        if self.stratum == "outside":
            return (OUTSIDE[self.number % len(OUTSIDE)],)
        if self.stratum == "single":
            return (SINGLES[self.number % len(SINGLES)],)
        rng = self.random("kinds")
        while True:
            first, second = (SINGLES[k] for k in rng.choice(len(SINGLES), 2, replace=False))
            if not {first, second} <= set(AT_MOST_ONE) and _bridges((first, second)):
                return first, second

    @property
    def bridge(self) -> str:
        """The bridge that it stands on."""
        return self._drawn[1]

    def case(self) -> Case:
        """The case itself."""
        seed, bridge, aims = self._drawn
        return draw_case(
            seed,
            bridge=bridge,
            kind="null" if self.null else self.kinds,
            reality=self._reality,
            conditions=self.circumstance.conditions,
            aims=aims,
        )

    @property
    def _drawn(self) -> tuple[int, str, tuple[float, float]]:
        """Seed, bridge and bounds of d' that are drawn."""
        rng = self.random("case")
        seed = int(rng.integers(2**31))
        bridges, aims = _bridges(self.kinds), AIMS[self.stratum]
        bridge = bridges[int(rng.integers(len(bridges)))]
        return seed, bridge, aims[int(rng.integers(3)) % len(aims)]

    @property
    def _reality(self) -> str:
        if "joint_rigidity" in self.kinds:
            return "truss" if self.null else "frame"
        return "frame" if self.circumstance.stiff else "truss"


def _bridges(kinds: tuple[str, ...]) -> list[str]:
    """The bridges that have what all of the kinds act on."""
    rng = np.random.default_rng(0)
    return [name for name, make in BRIDGES.items() if all(fits(kind, make(rng)) for kind in kinds)]
