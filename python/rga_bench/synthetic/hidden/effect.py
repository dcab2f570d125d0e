"""The form of a hidden effect: where it may be, how large it may get, what it does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.physics.world import World

Place = dict[str, Any]


@dataclass(frozen=True)
class EffectSetting:
    """What an effect is drawn for.

    The bridge, its time span [s], the noise of the sensors that are read in their units, and the
    contexts that were not measured.
    """

    bridge: Bridge
    duration: float
    noise: dict[str, float]
    latent: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Span:
    """A place and its range of values, from ``mild`` to ``severe``; None where it has no value.

    ``fixed`` are further parameters of the effect that are not graded.
    """

    place: Place
    mild: float | None = None
    severe: float | None = None
    log: bool = False
    parameter: str = ""  # where one kind has several
    fixed: dict[str, Any] = field(default_factory=dict)

    def at(self, severity: float) -> float | None:
        """The value at a severity of 0..1."""
        if self.mild is None or self.severe is None:
            return None
        if self.log:
            return float(self.mild * (self.severe / self.mild) ** severity)
        return float(self.mild + severity * (self.severe - self.mild))


class Kind(NamedTuple):
    """A kind of hidden effect.

    ``draw`` gives a place and span; ``act`` changes a world to have the effect from the first
    row on; ``onset`` is the probability that it starts later; one that may then grow rather than
    jump does nothing at ``neutral``.
    """

    parameter: str
    draw: Callable[[EffectSetting, np.random.Generator], Span]
    act: Callable[[World, Span, float], None]
    onset: float = 0.0
    neutral: float | None = None
    needs_cart: bool = False
    needs_width: bool = False


def either(rng: np.random.Generator, low: tuple[float, float], high: tuple[float, float]) -> Any:
    """One of two (mild, severe) pairs."""
    return low if rng.random() < 0.5 else high


def signed(rng: np.random.Generator, mild: float, severe: float) -> tuple[float, float]:
    """(mild, severe) with a random sign."""
    sign = float(rng.choice([-1.0, 1.0]))
    return sign * mild, sign * severe


def pick(rng: np.random.Generator, options: list[Any]) -> Any:
    """One of a list, as it is in the list."""
    return options[int(rng.integers(len(options)))]
