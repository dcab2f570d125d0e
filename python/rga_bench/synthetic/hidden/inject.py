"""Effects put into a reality: where, how large, from when on, and what the channels show of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rga_bench.synthetic.gauges import measure, observe
from rga_bench.synthetic.hidden.catalogue import HIDDEN, draw_hidden
from rga_bench.synthetic.hidden.effect import Span
from rga_bench.synthetic.noise import stream
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.world import World
from rga_bench.synthetic.reality import Reality, of_given

_LEVELS = np.linspace(0.0, 1.0, 5)  # of a ramp; between them the channels go straight
_RAMPS = 0.35


@dataclass(frozen=True)
class Placed:
    """An effect in a reality: ``onset`` and ``end`` of its ramp in [s], None where it has none."""

    kind: str
    span: Span
    value: float | None
    onset: float | None
    end: float | None = None
    d_prime: float = 0.0

    def act(self, world: World) -> None:
        """Change a world to have the effect in full."""
        amount = self.onset if self.kind == "sensor_fault" else self.value
        HIDDEN[self.kind].act(world, self.span, 0.0 if amount is None else amount)

    def at(self, level: float) -> Placed:
        """The effect of a ramp at a level of 0..1, as if it had always been there."""
        neutral = HIDDEN[self.kind].neutral
        assert neutral is not None
        assert self.value is not None
        return replace(self, value=neutral + level * (self.value - neutral), onset=None, end=None)

    @property
    def facts(self) -> dict[str, Any]:
        """What a truth file says of it."""
        return {
            "kind": self.kind,
            "onset": self.onset,
            "end": self.end,
            "place": self.span.place,
            "parameter": self.span.parameter or HIDDEN[self.kind].parameter or None,
            "value": self.value,
            "d_prime": self.d_prime,
            **self.span.fixed,
        }


def draw_placed(
    seed: int,
    kinds: Sequence[str],
    reality: Reality,
    ramps: bool,
    aims: tuple[float, float] | None = None,
) -> list[Placed]:
    """Effects of ``kinds``, each of a drawn size by itself; ``aims`` bounds its d'."""
    time = reality.time[: reality.rows]
    placed = []
    for kind in kinds:
        grows = stream(seed, f"profile {kind}")
        gradual = ramps and HIDDEN[kind].neutral is not None and grows.random() < _RAMPS
        lasts = float(grows.uniform(0.3, 1.0))

        def put(
            span: Span,
            value: float | None,
            onset: float | None,
            size: float = 0.0,
            kind: str = kind,
            gradual: bool = gradual,
            lasts: float = lasts,
        ) -> Placed:
            end = None
            if gradual and onset is not None:
                end = float(onset + lasts * (time[-1] - onset))
            return Placed(kind, span, value, onset, end, size)

        def size(span: Span, value: float | None, onset: float | None, put: Any = put) -> float:
            change = signature(reality, [put(span, value, onset)])
            return reality.size(of_given(change[: reality.rows], reality.given))

        rng = stream(seed, f"hidden {kind}")
        hidden = draw_hidden(kind, reality.setting(), rng, time, size, aims)
        placed.append(put(*hidden))
    return placed


def inhabited(reality: Reality, placed: Sequence[Placed]) -> World:
    """The world with all of the effects in full."""
    world = reality.world.copy()
    for one in placed:
        one.act(world)
    return world


def readings(reality: Reality, placed: Sequence[Placed]) -> Array:
    """The channels without noise over the record and after it, [n, c]."""
    time = reality.time
    for k, one in enumerate(placed):
        if one.end is not None and one.onset is not None:
            others = [*placed[:k], *placed[k + 1 :]]
            levels = np.stack([readings(reality, [*others, one.at(x)]) for x in _LEVELS])
            weight = np.clip((time - one.onset) / (one.end - one.onset), 0.0, 1.0)
            below = np.minimum((weight * (len(_LEVELS) - 1)).astype(int), len(_LEVELS) - 2)
            share = (weight * (len(_LEVELS) - 1) - below)[:, None]
            row = np.arange(len(time))
            return np.asarray((1 - share) * levels[below, row] + share * levels[below + 1, row])
    out = reality.clean.copy()
    begun = np.array([-np.inf if one.onset is None else one.onset for one in placed])
    on = time[:, None] >= begun
    for state in np.unique(on, axis=0):
        acting = [one for one, there in zip(placed, state, strict=True) if there]
        if acting:
            rows = (on == state).all(axis=1)
            out[rows] = observe(inhabited(reality, acting), reality.contexts, time)[rows]
    return out


def signature(reality: Reality, placed: Sequence[Placed]) -> Array:
    """What the effects change of what is read, less what the contexts lead one to expect, [n, c].

    An error of a measured context changes no channel, but what is expected of it.
    """
    change = readings(reality, placed) - reality.clean
    world = inhabited(reality, placed)
    if world.context_ops:
        measured = measure(world, reality.measured)
        expected = observe(reality.world, measured, reality.time)
        change -= expected - observe(reality.world, reality.measured, reality.time)
    return change
