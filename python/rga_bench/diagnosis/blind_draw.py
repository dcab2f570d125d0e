"""Draws of a blind challenge: each is known by its name, and stands beside its null twin."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self, TypeVar

import numpy as np

from rga.errors import InputError


@dataclass(frozen=True)
class BlindDraw:
    """A case of a challenge, by seed, stratum and number.

    Attributes:
        strata: share of the draws in each stratum.
        prefix: what the names begin with.
    """

    strata: ClassVar[Mapping[str, float]]
    prefix: ClassVar[str] = ""

    seed: int
    stratum: str
    number: int
    null: bool = False

    @property
    def id(self) -> str:
        """Its name, from which it can be drawn again."""
        twin = "-null" if self.null else ""
        return f"{self.prefix}{self.seed}-{self.stratum}-{self.number}{twin}"

    @classmethod
    def parse(cls, name: str) -> Self:
        """The draw of a name (InputError)."""
        strata = "|".join(cls.strata)
        found = re.fullmatch(rf"{cls.prefix}(\d+)-({strata})-(\d+)(-null)?", name)
        if found is None:
            raise InputError(
                f"{name!r} names no case of the challenge",
                "--case",
                f"write {cls.prefix}SEED-STRATUM-NUMBER, with -null for the twin; strata: "
                f"{', '.join(cls.strata)}",
            )
        seed, stratum, number, null = found.groups()
        return cls(int(seed), stratum, int(number), null is not None)

    def random(self, purpose: str) -> np.random.Generator:
        """Random numbers of one purpose; a draw and its twin have the same."""
        stratum = list(self.strata).index(self.stratum)
        return np.random.default_rng([self.seed, stratum, self.number, *purpose.encode()])


Kind = TypeVar("Kind", bound=BlindDraw)


def draws(seed: int, count: int, kind: type[Kind]) -> Sequence[Kind]:
    """The draws of a challenge of about `count` hidden effects, each before its null twin.

    The strata take turns by their shares, so that every beginning of the list is balanced.
    """
    order = []
    for stratum, share in kind.strata.items():
        many = max(1, round(share * count))
        order += [((k + 0.5) / many, kind(seed, stratum, k)) for k in range(many)]
    hidden = [draw for _, draw in sorted(order, key=lambda one: (one[0], one[1].stratum))]
    return [one for draw in hidden for one in (draw, replace(draw, null=True))]
