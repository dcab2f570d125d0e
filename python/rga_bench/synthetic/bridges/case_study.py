"""The bridge of the case study: a pedestrian pony truss, 46 m long, 2.6 m high and 3 m wide.

Two outer trusses carry the deck on cross beams, which hold the top chords upright through the
verticals (U-frames). Of what acts on it, only the uniform temperature is measured.
"""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge, Draft, section, steel

SPAN = 46.0  # [m]
HEIGHT, WIDTH = 2.6, 3.0  # [m]
SIDES = {"north": WIDTH, "south": 0.0}
PATCH = SPAN / 3.0  # of the crowd [m]
_PANELS = 10
_AXLES = 31  # a patch in small steps
_SOLID = 0.35  # share of a truss that the wind sees
_MM, _MICROSTRAIN = 0.15, 1.5  # noise of the sensors


def case_study_bridge() -> Bridge:
    """The twin's model of the bridge; the same every time."""
    draft = drafted("case study footbridge")
    steelwork(draft, _PANELS)
    contexts(draft)
    actions(draft, _PANELS)
    for side in SIDES:
        _sensors(draft, side)
    return Bridge(
        name="case study",
        model=draft.model,
        roles={"temperature": "temperature"},
        peaks={},
        bearings=[(f"east {side}", "ux") for side in SIDES],
        floor=["bottom chord"],
        jointed=["bottom chord", "top chord", "end posts", "diagonals"],
        area_load="crowd north",
    )


def drafted(name: str) -> Draft:
    """A model of these sections, without a member so far."""
    return Draft(
        name,
        {"steel": steel(2.05e11)},
        {
            "chord": section(0.0085, 1.2e-5, 4e-7),
            "diagonal": section(0.0042, 4e-6, 2e-7),
            "vertical": section(0.0050, 4e-5, 2e-5),
            "beam": section(0.0060, 8e-5, 2e-5),
            "rod": section(0.0012, 1.2e-7, 2e-7),
        },
    )


def steelwork(draft: Draft, panels: int, spans: int = 1) -> None:
    """Nodes, members and supports; any even number of panels, over spans of as many each."""
    for side, y in SIDES.items():
        for i in range(panels + 1):
            draft.node(low(side, i), i * spans * SPAN / panels, y, 0.0)
        for i in range(1, panels):
            draft.node(top(side, i), i * spans * SPAN / panels, y, HEIGHT)
    for side in SIDES:
        _truss(draft, side, panels)
    _deck(draft, panels)
    for i in range(0, panels + 1, panels // spans):
        end = {0: "west", panels: "east"}.get(i, f"pier {i}")
        for side in SIDES:
            fixed = ["uz", *(["ux"] if i == 0 else []), *(["uy"] if side == "south" else [])]
            draft.support(f"{end} {side}", low(side, i), *fixed)


def low(side: str, i: int) -> str:
    """Node of the bottom chord."""
    return f"{side}.L{i}"


def top(side: str, i: int) -> str:
    """Node of the top chord."""
    return f"{side}.U{i}"


def _truss(draft: Draft, side: str, panels: int) -> None:
    def add(one: str, other: str, kind: str, group: str) -> None:
        frame = "frame" if group == "verticals" else "truss"
        ends = (f"{side}.{one}", f"{side}.{other}")
        name = f"{side}.{one}-{other}"
        draft.member(ends, kind, [group, f"{side} truss"], name=name, kind=frame)

    for i in range(panels):
        add(f"L{i}", f"L{i + 1}", "chord", "bottom chord")
    for i in range(1, panels - 1):
        add(f"U{i}", f"U{i + 1}", "chord", "top chord")
    add("L0", "U1", "chord", "end posts")
    add(f"L{panels}", f"U{panels - 1}", "chord", "end posts")
    for i in range(1, panels):
        add(f"L{i}", f"U{i}", "vertical", "verticals")
    for i in range(1, panels // 2):
        add(f"U{i}", f"L{i + 1}", "diagonal", "diagonals")
        add(f"U{panels - i}", f"L{panels - i - 1}", "diagonal", "diagonals")


def _deck(draft: Draft, panels: int) -> None:
    for i in range(panels + 1):
        # Nothing holds the end beams against turning about themselves: they are pinned.
        kind = "frame" if 0 < i < panels else "truss"
        ends = (low("north", i), low("south", i))
        draft.member(ends, "beam", ["cross beams"], name=f"beam {i}", kind=kind)
    for i in range(panels):
        for one, other in (("north", "south"), ("south", "north")):
            ends = (low(one, i), low(other, i + 1))
            draft.member(ends, "rod", ["bracing"], name=f"brace {i} {one}")


def contexts(draft: Draft, spans: int = 1) -> None:
    """Temperature, sunshine, crowd and wind, with their ranges."""
    draft.context("temperature", "K", -30.0, 30.0)
    draft.model["context"]["temperature"]["noise"] = 0.3
    draft.context("gradient", "K", -5.0, 15.0)
    draft.context("crowd", "kPa", 0.3, 5.0)
    draft.context("position", "m", 0.2 * spans * SPAN, 0.8 * spans * SPAN)
    draft.context("eccentricity", "-", -0.6, 0.6)
    draft.context("wind", "kPa", -1.0, 1.0)


def actions(draft: Draft, panels: int, spans: int = 1) -> None:
    """Warmth, sunshine, the crowd and the wind, each driven by its context."""
    effects = draft.model["effects"]
    groups = {m["groups"][0]: 1.0 for m in draft.model["members"].values()}
    draft.warmth("warmth", "temperature", 0.0, groups)
    effects["sunshine"] = {
        "kind": "thermal_gradient",
        "axis": "vertical",
        "difference": {"context": "gradient"},
    }
    spread = PATCH * ((np.arange(_AXLES) + 0.5) / _AXLES - 0.5)
    crowds = [f"crowd {side}" for side in SIDES]
    for name, side in zip(crowds, SIDES, strict=True):
        effects[name] = {
            "kind": "axle_load",
            "path": [low(side, i) for i in range(panels + 1)],
            "carried_by": "nodes",
            "forces": [round(1e3 * PATCH * WIDTH / 2.0 / _AXLES, 3)] * _AXLES,
            "offsets": [round(float(x), 4) for x in spread],
            "factor": {"context": "crowd"},
            "position": {"context": "position"},
        }
    effects["crowd to one side"] = {
        "kind": "load_eccentricity",
        "effect": crowds,
        "share": {"context": "eccentricity"},
    }
    push = round(1e3 * _SOLID * (spans * SPAN / panels) * HEIGHT / 2.0, 3)  # on a node per kPa
    effects["wind"] = {
        "kind": "nodal_load",
        "forces": {node: [0, push, 0] for node in draft.model["nodes"]},
        "factor": {"context": "wind"},
    }


def _sensors(draft: Draft, side: str) -> None:
    for i in range(1, _PANELS):
        draft.moves(f"{side} z{i}", low(side, i), [0, 0, 1], _MM)
    middle = _PANELS // 2
    draft.moves(f"{side} y", low(side, middle), [0, 1, 0], _MM)
    draft.moves(f"{side} y top", top(side, middle), [0, 1, 0], _MM)
    draft.moves(f"{side} x", low(side, _PANELS), [1, 0, 0], _MM)
    gauged = ["L2-L3", "L4-L5", "L5-L6", "L7-L8", "U2-U3", "U4-U5", "U7-U8", "U1-L2", "U9-L8"]
    for member in gauged:
        draft.strains(f"{side} e {member}", f"{side}.{member}", _MICROSTRAIN)
