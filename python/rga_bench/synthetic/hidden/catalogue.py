"""All hidden kinds, and the drawing of one: a place, then a value of the size wanted."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.hidden.effect import EffectSetting, Kind, Span
from rga_bench.synthetic.hidden.gauge import GAUGE
from rga_bench.synthetic.hidden.load import HYSTERESIS, LOAD
from rga_bench.synthetic.hidden.structure import CLEARANCE, STRUCTURE

DRAWN: dict[str, Kind] = {**STRUCTURE, **LOAD, **GAUGE}
HIDDEN: dict[str, Kind] = {**DRAWN, **CLEARANCE, **HYSTERESIS}
KINDS = ("null", *HIDDEN)
_PLACES = 8
_HALVINGS = 9
VISIBLE = 8.0


class Hidden(NamedTuple):
    """A drawn effect; ``value`` is None where the kind has none, ``onset`` in [s]."""

    span: Span
    value: float | None
    onset: float | None
    d_prime: float


def fits(kind: str, bridge: Bridge) -> bool:
    """Whether the bridge has what the kind acts on."""
    if kind == "null":
        return True
    wide = bridge.model.get("plane") is None
    return (bool(bridge.carts) or not HIDDEN[kind].needs_cart) and (
        wide or not HIDDEN[kind].needs_width
    )


def draw_hidden(
    kind: str,
    setting: EffectSetting,
    rng: np.random.Generator,
    time: np.ndarray,
    size_of: Callable[[Span, float | None, float | None], float],
    aims: tuple[float, float] | None = None,
) -> Hidden:
    """Draw a place that can be seen, then the value whose d' meets a drawn aim.

    ``size_of`` gives the d' of (span, value, onset). The aim lies within ``aims``; left out, it
    is 15..60 in three cases of four, 5..15 in the others. Where no value reaches it, the nearest
    is taken.
    """
    usual = (15.0, 60.0) if rng.random() < 0.75 else (5.0, 15.0)
    low, high = aims or usual
    aim = float(np.exp(rng.uniform(np.log(low), np.log(high))))
    late = rng.random() < HIDDEN[kind].onset
    onset = float(time[int(rng.uniform(0.25, 0.7) * len(time))]) if late else None
    return sized(kind, setting, rng, onset, aim, size_of, visible=aim if aims else VISIBLE)


def sized(
    kind: str,
    setting: EffectSetting,
    rng: np.random.Generator,
    onset: float | None,
    aim: float,
    size_of: Callable[[Span, float | None, float | None], float],
    visible: float = VISIBLE,
) -> Hidden:
    """Draw a place where d' may reach ``visible``, then the value whose d' meets ``aim``."""
    best: tuple[float, Span] | None = None
    for _ in range(_PLACES):
        span = HIDDEN[kind].draw(setting, rng)
        most = size_of(span, span.at(1.0), onset)
        if best is None or most > best[0]:
            best = (most, span)
        if most >= visible:
            break
    assert best is not None
    most, span = best
    if span.mild is None or span.mild == span.severe or most <= aim:
        return Hidden(span, span.at(1.0), onset, most)
    below, above = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (below + above)
        if size_of(span, span.at(middle), onset) < aim:
            below = middle
        else:
            above = middle
    value = float(f"{span.at(above):.6g}")
    return Hidden(span, value, onset, size_of(span, value, onset))
