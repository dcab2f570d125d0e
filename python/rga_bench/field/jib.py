"""A jib crane: a pillar, and a boom of three chords that hangs from its head by two ties."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rga_bench.field.structure import FieldStructure, pushes, tube
from rga_bench.synthetic.bridges.model_draft import Draft, steel

_BAYS = 6
_WIDTH, _DEEP = 1.0, 1.1


def jib(rng: np.random.Generator) -> FieldStructure:
    """The trolley runs along the lower chords; its load is shared by both."""
    bay, height = float(rng.uniform(1.8, 2.4)), float(rng.uniform(8.0, 11.0))
    sections = {
        "pillar": tube(0.508, 0.016),
        "chord": tube(0.0889, 0.0063),
        "lacing": tube(0.0424, 0.0032),
        "tie": {"A": 8.0e-4},
    }
    draft = Draft("jib crane", {"steel": steel(2.1e11)}, sections)
    for name, z in (("foot", 0.0), ("waist", 0.5 * height), ("root", height)):
        draft.node(name, 0.0, 0.0, z)
    draft.node("neck", 0.0, 0.0, height + _DEEP)
    draft.node("head", 0.0, 0.0, height + 4.0)
    line = ("foot", "waist", "root", "neck", "head")
    for ends in pairwise(line):
        draft.member(ends, "pillar", ["pillar"], kind="frame")
    for i in range(_BAYS + 1):
        x = 0.6 + bay * i
        draft.node(f"s{i}", x, -0.5 * _WIDTH, height)
        draft.node(f"n{i}", x, 0.5 * _WIDTH, height)
        draft.node(f"t{i}", x, 0.0, height + _DEEP)
    for end, on in (("s0", "root"), ("n0", "root"), ("t0", "neck")):
        # A bracket that is welded to the pillar.
        draft.member((on, end), "pillar", ["brackets"], kind="frame")
    for i in range(_BAYS):
        for side in ("s", "n", "t"):
            group = "top chord" if side == "t" else "lower chords"
            draft.member((f"{side}{i}", f"{side}{i + 1}"), "chord", [group])
        draft.member((f"s{i}", f"n{i + 1}"), "lacing", ["lacing"])
        for side in ("s", "n"):
            draft.member((f"t{i}", f"{side}{i + 1}"), "lacing", ["lacing"])
    for i in range(_BAYS + 1):
        draft.member((f"s{i}", f"n{i}"), "lacing", ["lacing"])
        for side in ("s", "n"):
            draft.member((f"t{i}", f"{side}{i}"), "lacing", ["lacing"])
    hung = _BAYS - 2
    for side in ("s", "n"):
        draft.member(("head", f"{side}{hung}"), "tie", ["ties"], name=f"tie {side}")
    draft.support("foundation", "foot", "ux", "uy", "uz", "rx", "ry", "rz")
    draft.context("air", "degC", -20, 45)
    draft.context("trolley", "m", 0.0, round(bay * _BAYS, 3))
    draft.context("hoist", "kN", 0, 40)
    draft.context("wind", "kPa", -1.2, 1.2)
    warm = ("pillar", "brackets", "lower chords", "top chord", "lacing", "ties")
    draft.warmth("warmth", "air", 12.0, dict.fromkeys(warm, 1.0))
    for side in ("s", "n"):
        path = [f"{side}{i}" for i in range(_BAYS + 1)]
        draft.cart(f"load {side}", path, 500.0, "trolley", "hoist")
    across = {f"{side}{i}": [0.0, 250.0 * bay, 0.0] for i in range(_BAYS + 1) for side in "snt"}
    pushes(draft, "wind load", "wind", across | {"waist": [0.0, 2500.0, 0.0]})
    # A boom that moves by decimetres is measured with lasers.
    mm, strain = float(rng.uniform(0.6, 1.2)), float(rng.uniform(0.8, 1.5))
    for i in (2, 4, 6):
        draft.moves(f"Vs{i}", f"s{i}", [0, 0, 1], round(mm, 3))
        draft.moves(f"Vn{i}", f"n{i}", [0, 0, 1], round(mm, 3))
    draft.moves("head x", "head", [1, 0, 0], round(mm, 3))
    draft.moves("head y", "head", [0, 1, 0], round(mm, 3))
    draft.moves("tip y", f"t{_BAYS}", [0, 1, 0], round(mm, 3))
    for name in ("waist", "root"):
        draft.tilts(f"tilt {name}", name, [0, 1, 0], round(0.15 * mm, 4))
    draft.tilts("sway root", "root", [1, 0, 0], round(0.15 * mm, 4))
    gauged = ["tie s", "tie n", "s1-s2", "n1-n2", "s4-s5", "n4-n5", "t1-t2", "t3-t4"]
    gauged += ["t0-s1", "t0-n1", "t4-s5", "t4-n5", "s0-n1"]
    for name in gauged:
        draft.strains(f"S {name}", name, round(strain, 3))
    for name in ("foot-waist", "waist-root"):
        for face, z in (("front", 0.25), ("back", -0.25)):
            draft.strains(f"P {name} {face}", name, round(strain, 3))
            draft.model["members"][name]["local_y"] = [0.0, 1.0, 0.0]
            draft.model["sensors"][f"P {name} {face}"] |= {"at": 0.5, "z": z}
    return FieldStructure(
        name="jib",
        model=draft.model,
        moods={
            "air": ("air", 1.0), "trolley": ("trolley", bay * _BAYS), "hoist": ("hoist", 15.0),
            "wind": ("wind", 0.3),
        },
        depths={"pillar": 0.25, "chord": 0.044, "lacing": 0.021, "tie": 0.0},
        loads=["load s", "load n", "wind load"],
    )  # fmt: skip
