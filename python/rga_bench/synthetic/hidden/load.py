"""Hidden effects in temperature and loads, and those outside the vocabulary."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.hidden.effect import EffectSetting, Kind, Span, either, pick, signed
from rga_bench.synthetic.physics.world import Curiosity, World

Rng = np.random.Generator


def _expansion(s: EffectSetting, rng: Rng) -> Span:
    mild, severe = either(rng, (0.95, 0.6), (1.05, 1.5))
    return Span({"material": pick(rng, list(s.bridge.model["materials"]))}, mild, severe)


def _expand(w: World, span: Span, value: float) -> None:
    w.alpha = np.where(w.members_of(material=span.place["material"]), value * w.alpha, w.alpha)


def _gradient(s: EffectSetting, rng: Rng) -> Span:
    flat = s.bridge.model.get("plane") == "xz"
    axis = "vertical" if flat or rng.random() < 0.8 else "lateral"
    if rng.random() < 0.8:
        return Span({"axis": axis}, *signed(rng, 0.01, 0.9), parameter="ratio")
    return Span({"axis": axis}, *signed(rng, 0.3, 15.0), parameter="difference")


def _shade(w: World, span: Span, value: float) -> None:
    both = (value, 0.0) if span.parameter == "ratio" else (0.0, value)
    w.gradient[span.place["axis"]] = both


def _loads(s: EffectSetting, rng: Rng) -> list[str] | str:
    """The distributed load, or both sides of the cart."""
    if s.bridge.carts and rng.random() < 0.5:
        return list(s.bridge.carts)
    return s.bridge.area_load


def _scaled(s: EffectSetting, rng: Rng) -> Span:
    mild, severe = either(rng, (0.96, 0.5), (1.04, 1.8))
    return Span({"effect": _loads(s, rng)}, mild, severe)


def _named(span: Span) -> list[str]:
    effect = span.place["effect"]
    return [effect] if isinstance(effect, str) else list(effect)


def _scale(w: World, span: Span, value: float) -> None:
    w.load_factor.update(dict.fromkeys(_named(span), value))


def _shifted(s: EffectSetting, rng: Rng) -> Span:
    return Span({"effect": list(s.bridge.carts)}, *signed(rng, 0.05, 4.0))


def _shift(w: World, span: Span, value: float) -> None:
    w.load_shift.update(dict.fromkeys(_named(span), value))


def _leaning(s: EffectSetting, rng: Rng) -> Span:
    return Span({"effect": _loads(s, rng)}, *signed(rng, 0.01, 0.45))


def _lean(w: World, span: Span, value: float) -> None:
    w.load_share.update(dict.fromkeys(_named(span), value))


def _weather(s: EffectSetting, rng: Rng) -> Span:
    members = s.bridge.model["members"].values()
    sides = sorted({g for m in members for g in m["groups"][1:]})
    group = s.bridge.floor[0] if s.bridge.push[2] else pick(rng, sides)
    place = {
        "group": group,
        "direction": list(s.bridge.push),
        "context": s.bridge.roles["idle"],
    }
    # From 20 N/m to 20 kN/m at the peak of the context, whatever its unit.
    sized = 1.0 / s.bridge.peaks["idle"]
    return Span(place, 20.0 * sized, 2e4 * sized, log=True)


def _blow(w: World, span: Span, value: float) -> None:
    force = np.zeros(6 * len(w.geometry.xyz))
    for m in np.flatnonzero(w.members_of(group=span.place["group"])):
        for node in w.geometry.ends[m]:
            push = value * w.geometry.length[m] / 2.0 * np.array(span.place["direction"])
            force[6 * node : 6 * node + 3] += push
    w.added_load.append((span.place["context"], force))


def _strange(s: EffectSetting, rng: Rng) -> Span:
    variant = pick(rng, ["softening", "squared temperature", "tide"])
    if variant == "softening":
        return Span({}, *signed(rng, 0.03, 0.6), fixed={"variant": variant})
    return _pushing(s, rng, variant)


def _slow(s: EffectSetting, rng: Rng) -> Span:
    return _pushing(s, rng, "hysteresis")


def _pushing(s: EffectSetting, rng: Rng, variant: str) -> Span:
    nodes = [k for k, xyz in enumerate(s.bridge.model["nodes"].values()) if xyz[2] == 0.0]
    few = [nodes[i] for i in rng.choice(len(nodes), 4, replace=False)]
    # Unequal forces on a few nodes make a shape that no load of the model has.
    pushes = [float(x) for x in rng.normal(0.0, 1.0, 4)]
    fixed = {"variant": variant, "nodes": few, "pushes": pushes}
    return Span({}, 5e2, 2e5, log=True, fixed=fixed)


def _puzzle(w: World, span: Span, value: float) -> None:
    force = np.zeros(6 * len(w.geometry.xyz))
    for node, push in zip(span.fixed.get("nodes", []), span.fixed.get("pushes", []), strict=True):
        force[6 * node + 2] += push
    w.curiosity = Curiosity(span.fixed["variant"], value, force)


LOAD = {
    "thermal_expansion": Kind("factor", _expansion, _expand),
    "thermal_gradient": Kind("ratio", _gradient, _shade),
    "load_scale": Kind("factor", _scaled, _scale),
    "load_position": Kind("offset", _shifted, _shift, needs_cart=True),
    "load_eccentricity": Kind("share", _leaning, _lean, needs_width=True),
    "unmodelled_load": Kind("rate", _weather, _blow),
    "unknown": Kind("", _strange, _puzzle),
}
#: drawn where it is named; the cases of a seed are those without it
HYSTERESIS = {"hysteresis": Kind("", _slow, _puzzle)}
