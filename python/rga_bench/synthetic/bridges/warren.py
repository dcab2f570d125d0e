"""Warren bridge with verticals: twelve panels over two spans, fixed on the middle pier."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge, Draft, section, steel

_PANELS, _PANEL, _HEIGHT, _WIDTH = 12, 4.0, 4.2, 4.6
_PIER = _PANELS // 2
_SIDES = {"N": _WIDTH, "S": 0.0}


def warren(rng: np.random.Generator) -> Bridge:
    """Sizes and sensor quality vary with ``rng``, the layout does not."""
    size, stout = rng.uniform(0.85, 1.25), rng.uniform(0.5, 1.8)
    draft = Draft(
        "Ostra crossing",
        {"S355": steel(2.1e11), "S235": steel(2.05e11)},
        {
            "chord": section(0.010 * size, 3.0e-4 * stout, 2e-6),
            "brace": section(0.0060 * size, 1.0e-4 * stout, 7e-7),
            "hanger": section(0.0040, 5.0e-5 * stout, 4e-7),
            "girder": section(0.009, 1.1e-4, 9e-7),
            "rod": section(0.0018, 6e-7, 6e-8),
        },
    )
    for side, y in _SIDES.items():
        for i in range(_PANELS + 1):
            draft.node(f"{side}.L{i}", i * _PANEL, y, 0.0)
        for i in range(1, _PANELS):
            draft.node(f"{side}.U{i}", i * _PANEL, y, _HEIGHT)
    for side in _SIDES:
        _truss(draft, side)
    _bracing(draft)
    for end, i, along in (("west", 0, False), ("pier", _PIER, True), ("east", _PANELS, False)):
        for side in _SIDES:
            fixed = ["uz"] + (["ux"] if along else []) + (["uy"] if side == "S" else [])
            draft.support(f"{end} {side}", f"{side}.L{i}", *fixed)
    _loads(draft)
    _sensors(draft, float(rng.uniform(0.04, 0.1)), float(rng.uniform(0.6, 1.2)))
    return Bridge(
        name="warren",
        model=draft.model,
        roles={
            "temperature": "T_steel",
            "area": "deck_load",
            "position": "trolley",
            "weight": "trolley_weight",
            "idle": "wind_pressure",
        },
        peaks={
            "area": 5000.0,
            "position": _PANELS * _PANEL,
            "weight": float(rng.uniform(5e4, 1.2e5)),
            "idle": 300.0,
        },
        bearings=[(f"{end} {side}", "ux") for end in ("west", "east") for side in _SIDES],
        floor=["bottom"],
        jointed=["bottom", "top", "diagonals", "verticals"],
        area_load="deck",
        carts=["trolley N", "trolley S"],
    )


def _truss(draft: Draft, side: str) -> None:
    count = 0

    def add(one: str, other: str, section_name: str, group: str, material: str) -> None:
        nonlocal count
        count += 1
        ends = (f"{side}.{one}", f"{side}.{other}")
        name = f"{side}{count:02d}"
        draft.member(ends, section_name, [group, f"{side} side"], name=name, material=material)

    for i in range(_PANELS):
        add(f"L{i}", f"L{i + 1}", "chord", "bottom", "S355")
    for i in range(1, _PANELS - 1):
        add(f"U{i}", f"U{i + 1}", "chord", "top", "S355")
    for i in range(_PANELS):
        up = i % 2 == 0
        one, other = (f"L{i}", f"U{i + 1}") if up else (f"U{i}", f"L{i + 1}")
        add(one, other, "brace", "diagonals", "S355")
    for i in range(1, _PANELS):
        add(f"L{i}", f"U{i}", "hanger", "verticals", "S235")


def _bracing(draft: Draft) -> None:
    count = 0

    def add(one: str, other: str, section_name: str, group: str) -> None:
        nonlocal count
        count += 1
        draft.member((one, other), section_name, [group], name=f"X{count:02d}", material="S235")

    for i in range(_PANELS + 1):
        add(f"N.L{i}", f"S.L{i}", "girder", "cross beams")
    for i in range(_PANELS):
        add(f"N.L{i}", f"S.L{i + 1}", "rod", "floor bracing")
        add(f"S.L{i}", f"N.L{i + 1}", "rod", "floor bracing")
    for i in range(1, _PANELS):
        add(f"N.U{i}", f"S.U{i}", "rod", "roof struts")
        add(f"N.L{i}", f"S.U{i}", "rod", "frames")
        add(f"S.L{i}", f"N.U{i}", "rod", "frames")
    for i in range(1, _PANELS - 1):
        add(f"N.U{i}", f"S.U{i + 1}", "rod", "roof bracing")
        add(f"S.U{i}", f"N.U{i + 1}", "rod", "roof bracing")


def _loads(draft: Draft) -> None:
    draft.context("T_steel", "degC", -20, 50)
    draft.context("deck_load", "N/m2", 0, 8000)
    draft.context("trolley", "m", 0, _PANELS * _PANEL)
    draft.context("trolley_weight", "N", 0, 150000)
    draft.context("wind_pressure", "Pa", 0, 900)
    groups = {m["groups"][0]: 1.0 for m in draft.model["members"].values()}
    draft.warmth("temp", "T_steel", 10.0, groups)
    tributary = _PANEL * _WIDTH / 2
    down = {
        f"{side}.L{i}": tributary * (0.5 if i in (0, _PANELS) else 1.0)
        for i in range(_PANELS + 1)
        for side in _SIDES
    }
    draft.area("deck", "deck_load", down)
    for side in _SIDES:
        path = [f"{side}.L{i}" for i in range(_PANELS + 1)]
        draft.cart(f"trolley {side}", path, 0.5, "trolley", "trolley_weight")


def _sensors(draft: Draft, mm: float, strain: float) -> None:
    for side in _SIDES:
        for i in (2, 3, 4, 8, 9, 10):
            draft.moves(f"{side}-z{i}", f"{side}.L{i}", [0, 0, 1], round(mm, 3))
        for i in (0, _PANELS):
            draft.moves(f"{side}-x{i}", f"{side}.L{i}", [1, 0, 0], round(mm, 3))
        mid = 3 if side == "N" else 9
        draft.moves(f"{side}-y{mid}", f"{side}.L{mid}", [0, 1, 0], round(mm, 3))
        for k in (2, 3, 6, 9, 10, 15, 17, 20, 26, 28, 31):
            draft.strains(f"{side}-e{k:02d}", f"{side}{k:02d}", round(strain, 3))
