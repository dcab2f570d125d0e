"""Hidden effects in members and supports."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.hidden.effect import EffectSetting, Kind, Span, either, pick
from rga_bench.synthetic.physics.frame import Array, FrameSpring
from rga_bench.synthetic.physics.world import Friction, Stop, StrandBar, World

Rng = np.random.Generator


def _masked(mask: Array, factor: float) -> Array:
    return np.where(mask, factor, 1.0)


def _modulus(s: EffectSetting, rng: Rng) -> Span:
    mild, severe = either(rng, (0.96, 0.72), (1.04, 1.4))
    return Span({"material": pick(rng, list(s.bridge.model["materials"]))}, mild, severe)


def _soften_material(w: World, span: Span, value: float) -> None:
    w.scale_stiffness(_masked(w.members_of(material=span.place["material"]), value))


def _member(s: EffectSetting, rng: Rng) -> Span:
    if rng.random() < 0.25:
        return Span({"group": pick(rng, s.bridge.jointed)}, 0.94, 0.5)
    members = s.bridge.model["members"].items()
    main = [name for name, m in members if m["groups"][0] in s.bridge.jointed + s.bridge.floor]
    return Span({"member": pick(rng, main)}, 0.8, 0.3)


def _soften_member(w: World, span: Span, value: float) -> None:
    w.scale_stiffness(_masked(w.members_of(**span.place), value))


def _bearings(s: EffectSetting, rng: Rng) -> dict[str, object]:
    """One expansion bearing, or all that share the end of the first."""
    names = [name for name, _ in s.bridge.bearings]
    first = pick(rng, names)
    nodes, supports = s.bridge.model["nodes"], s.bridge.model["supports"]
    x = nodes[supports[first]["node"]][0]
    same = [name for name in names if nodes[supports[name]["node"]][0] == x]
    if len(same) > 1 and rng.random() < 0.4:
        return {"support": same, "dof": "ux"}
    return {"support": first, "dof": "ux"}


def _dofs(w: World, span: Span, name: str = "") -> list[int]:
    support = span.place["support"]
    supports = [support] if isinstance(support, str) else support
    return [w.support_dof(one, name or span.place["dof"]) for one in supports]


def _restraint(s: EffectSetting, rng: Rng) -> Span:
    return Span(_bearings(s, rng), 1e5, 2e9, log=True)


def _restrain(w: World, span: Span, value: float) -> None:
    w.springs += [FrameSpring(dof, None, value) for dof in _dofs(w, span)]


def _seat(s: EffectSetting, rng: Rng) -> Span:
    supports = s.bridge.model["supports"]
    return Span({"support": pick(rng, list(supports)), "dof": "uz"}, 3e9, 1e7, log=True)


def _loosen(w: World, span: Span, value: float) -> None:
    w.held -= set(_dofs(w, span))
    _restrain(w, span, value)


def _sinking(s: EffectSetting, rng: Rng) -> Span:
    sign = -1.0 if rng.random() < 0.85 else 1.0
    place = {"support": pick(rng, list(s.bridge.model["supports"])), "dof": "uz"}
    return Span(place, sign * 2e-4, sign * 0.02, log=True)


def _settle(w: World, span: Span, value: float) -> None:
    w.settlement.update(dict.fromkeys(_dofs(w, span), value))


def _deck(s: EffectSetting, rng: Rng) -> Span:
    group = pick(rng, s.bridge.floor)
    area = _group_area(s, group)
    return Span({"group": group}, 0.03 * area, 1.5 * area, log=True)


def _group_area(s: EffectSetting, group: str) -> float:
    model = s.bridge.model
    first = next(m for m in model["members"].values() if group in m["groups"])
    return float(model["sections"][first["section"]]["A"])


def _add_area(w: World, span: Span, value: float) -> None:
    e = np.array([w.model["materials"][m["material"]]["E"] for m in w.model["members"].values()])
    added = np.where(w.members_of(group=span.place["group"]), e * value, 0.0)
    w.section = w.section._replace(ea=w.section.ea + added)


def _stringers(s: EffectSetting, rng: Rng) -> Span:
    group = pick(rng, s.bridge.floor)
    tie = float(np.exp(rng.uniform(np.log(1e8), np.log(2e9))))
    area = _group_area(s, group)
    fixed = {"connector_stiffness": tie}
    return Span({"group": group}, 0.05 * area, 4.0 * area, log=True, fixed=fixed)


def _add_strands(w: World, span: Span, value: float) -> None:
    members = list(w.model["members"].values())
    beside: dict[int, int] = {}
    for m in np.flatnonzero(w.members_of(group=span.place["group"])):
        for node in w.geometry.ends[m]:
            if node not in beside:
                beside[node] = w.size
                w.extra += 1
                tie = span.fixed["connector_stiffness"]
                w.springs.append(FrameSpring(6 * int(node), beside[node], tie))
        i, j = sorted(w.geometry.ends[m], key=lambda n: float(w.geometry.xyz[n, 0]))
        e = w.model["materials"][members[m]["material"]]["E"]
        bar = StrandBar(beside[i], beside[j], int(m), e * value / float(w.geometry.length[m]))
        w.strands.append(bar)


def _joints(s: EffectSetting, rng: Rng) -> Span:
    severe = float(10.0 ** rng.uniform(7.7, 9.0))
    return Span({"group": list(s.bridge.jointed)}, 3e4, severe, log=True)


def _join(w: World, span: Span, value: float) -> None:
    w.join(span.place["group"], value)


def _sticking(s: EffectSetting, rng: Rng) -> Span:
    fixed = {"permanent_force": float(np.round(rng.uniform(2e4, 1e5), -3))}
    return Span(_bearings(s, rng), 0.01, 0.4, log=True, fixed=fixed)


def _stick(w: World, span: Span, value: float) -> None:
    w.friction = Friction(
        _dofs(w, span), _dofs(w, span, "uz"), value, span.fixed["permanent_force"]
    )


def _loose_bolts(s: EffectSetting, rng: Rng) -> Span:
    if rng.random() < 0.3:
        return Span({"group": pick(rng, s.bridge.jointed)}, 1e-5, 4e-3, log=True)
    members = s.bridge.model["members"].items()
    main = [name for name, m in members if m["groups"][0] in s.bridge.jointed + s.bridge.floor]
    return Span({"member": pick(rng, main)}, 1e-5, 4e-3, log=True)


def _slip(w: World, span: Span, value: float) -> None:
    w.slip = np.where(w.members_of(**span.place), value, 0.0)


def _stopped(s: EffectSetting, rng: Rng) -> Span:
    fixed = {"gap": float(np.round(rng.uniform(5e-4, 4e-3), 5))}
    return Span(_bearings(s, rng), 1e5, 2e9, log=True, fixed=fixed)


def _stop(w: World, span: Span, value: float) -> None:
    w.stop = Stop(_dofs(w, span), span.fixed["gap"], value)


STRUCTURE = {
    "elastic_modulus": Kind("factor", _modulus, _soften_material),
    "member_stiffness": Kind("factor", _member, _soften_member, onset=0.3, neutral=1.0),
    "support_spring": Kind("stiffness", _restraint, _restrain, onset=0.3),
    "support_flexibility": Kind("stiffness", _seat, _loosen, onset=0.3),
    "support_settlement": Kind("displacement", _sinking, _settle, onset=1.0, neutral=0.0),
    "added_axial_area": Kind("area", _deck, _add_area),
    "floor_participation": Kind("area", _stringers, _add_strands),
    "joint_rigidity": Kind("stiffness", _joints, _join),
    "bearing_friction": Kind("mu", _sticking, _stick),
}
#: drawn where they are named; the cases of a seed are those without them
CLEARANCE = {
    "joint_slip": Kind("slip", _loose_bolts, _slip),
    "support_gap": Kind("stiffness", _stopped, _stop),
}
