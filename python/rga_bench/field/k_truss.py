"""A bridge of the K type, one of its trusses in its plane."""

from __future__ import annotations

import numpy as np

from rga_bench.field.structure import FieldStructure
from rga_bench.synthetic.bridges.model_draft import Draft, steel

_PANELS = 8


def k_truss(rng: np.random.Generator) -> FieldStructure:
    """Webs meet the posts at half of their height; open towards the middle of the span."""
    panel, height = float(rng.uniform(6.0, 8.0)), float(rng.uniform(10.0, 13.0))
    sections = {
        "lower": {"A": 0.024, "Iy": 3.6e-4, "Iz": 1.5e-4, "J": 2.0e-6},
        "upper": {"A": 0.030, "Iy": 4.8e-4, "Iz": 2.1e-4, "J": 3.0e-6},
        "post": {"A": 0.010, "Iy": 7.0e-5, "Iz": 4.0e-5, "J": 8.0e-7},
        "diagonal": {"A": 0.014, "Iy": 1.3e-4, "Iz": 6.0e-5, "J": 1.0e-6},
    }
    draft = Draft("K truss", {"steel": steel(2.1e11)}, sections)
    draft.model["plane"] = "xz"
    inner = range(1, _PANELS)
    for i in range(_PANELS + 1):
        draft.node(f"L{i}", panel * i, 0.0, 0.0)
    for i in inner:
        draft.node(f"U{i}", panel * i, 0.0, height)
        if i not in (1, _PANELS - 1):
            draft.node(f"M{i}", panel * i, 0.0, 0.5 * height)
    for i in range(_PANELS):
        draft.member((f"L{i}", f"L{i + 1}"), "lower", ["lower chord"])
    for i in inner[:-1]:
        draft.member((f"U{i}", f"U{i + 1}"), "upper", ["upper chord"])
    draft.member(("L0", "U1"), "upper", ["upper chord"])
    draft.member((f"U{_PANELS - 1}", f"L{_PANELS}"), "upper", ["upper chord"])
    for i in inner:
        if i in (1, _PANELS - 1):
            draft.member((f"L{i}", f"U{i}"), "post", ["posts"])
            continue
        draft.member((f"L{i}", f"M{i}"), "post", ["posts"])
        draft.member((f"M{i}", f"U{i}"), "post", ["posts"])
        outer = [i - 1] if 2 * i < _PANELS else [i + 1] if 2 * i > _PANELS else [i - 1, i + 1]
        for other in outer:
            draft.member((f"L{other}", f"M{i}"), "diagonal", ["diagonals"])
            draft.member((f"U{other}", f"M{i}"), "diagonal", ["diagonals"])
    draft.support("west", "L0", "ux", "uz")
    draft.support("east", f"L{_PANELS}", "uz")
    draft.context("air", "degC", -20, 45)
    draft.context("west lanes", "kN/m", 0, 40)
    draft.context("east lanes", "kN/m", 0, 40)
    groups = {"lower chord": 1.0, "upper chord": 1.0, "posts": 1.0, "diagonals": 1.0}
    draft.warmth("warmth", "air", 12.0, groups)
    middle = _PANELS // 2
    for name, nodes in (("west lanes", range(1, middle)), ("east lanes", range(middle, _PANELS))):
        draft.area(f"load {name}", name, {f"L{i}": 1e3 * panel for i in nodes})
    mm, strain = float(rng.uniform(0.1, 0.3)), float(rng.uniform(0.4, 1.0))
    for i in inner:
        draft.moves(f"V{i}", f"L{i}", [0, 0, 1], round(mm, 3))
    draft.moves("joint", f"L{_PANELS}", [1, 0, 0], round(mm, 3))
    draft.moves("sway", f"U{middle}", [1, 0, 0], round(mm, 3))
    gauged = ["L1-L2", "L3-L4", "L4-L5", "L6-L7", "U2-U3", "U4-U5", "U5-U6", "L0-U1", "U7-L8"]
    gauged += ["L1-M2", "U1-M2", "L3-M4", "L5-M4", "U5-M4", "L2-M2", "M6-U6", "L1-U1"]
    for name in gauged:
        draft.strains(f"S {name}", name, round(strain, 3))
    return FieldStructure(
        name="K truss",
        model=draft.model,
        moods={
            "air": ("air", 1.0), "west lanes": ("traffic", 9.0), "east lanes": ("traffic", 9.0),
        },
        depths={"lower": 0.2, "upper": 0.2, "post": 0.12, "diagonal": 0.15},
        loads=["load west lanes", "load east lanes"],
    )  # fmt: skip
