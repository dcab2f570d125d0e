"""A double-layer roof, square on square, offset."""

from __future__ import annotations

import numpy as np

from rga_bench.field.structure import FieldStructure, tube
from rga_bench.synthetic.bridges.model_draft import Draft, steel

_CELLS = 4


def roof(rng: np.random.Generator) -> FieldStructure:
    """Tubes between ball joints, on four corners or on eight columns."""
    side, depth = float(rng.uniform(2.4, 3.2)), float(rng.uniform(1.6, 2.2))
    sections = {"chord": tube(0.1016, 0.005), "web": tube(0.0761, 0.004)}
    draft = Draft("space roof", {"steel": steel(2.1e11)}, sections)
    top, bottom = range(_CELLS + 1), range(_CELLS)
    for i in top:
        for j in top:
            draft.node(f"t{i}{j}", side * i, side * j, depth)
    for i in bottom:
        for j in bottom:
            draft.node(f"b{i}{j}", side * (i + 0.5), side * (j + 0.5), 0.0)
    for layer, several, group in (("t", top, "top"), ("b", bottom, "bottom")):
        for i in several[:-1]:
            for j in several:
                draft.member((f"{layer}{i}{j}", f"{layer}{i + 1}{j}"), "chord", [group])
                draft.member((f"{layer}{j}{i}", f"{layer}{j}{i + 1}"), "chord", [group])
    for i in bottom:
        for j in bottom:
            for di in (0, 1):
                for dj in (0, 1):
                    draft.member((f"b{i}{j}", f"t{i + di}{j + dj}"), "web", ["web"])
    last = _CELLS
    draft.support("SW", "t00", "ux", "uy", "uz")
    draft.support("SE", f"t{last}0", "uy", "uz")
    draft.support("NW", f"t0{last}", "ux", "uz")
    draft.support("NE", f"t{last}{last}", "uz")
    if rng.random() < 0.5:
        for name, node in (("S", "t20"), ("W", "t02"), ("E", f"t{last}2"), ("N", f"t2{last}")):
            draft.support(name, node, "uz")
    draft.context("air", "degC", -20, 45)
    draft.context("snow", "kPa", 0, 2.5)
    draft.context("drift", "kPa", 0, 2.5)
    draft.warmth("warmth", "air", 12.0, {"top": 1.0, "bottom": 1.0, "web": 1.0})
    share = {i: 0.5 if i in (0, last) else 1.0 for i in top}
    down = {f"t{i}{j}": 1e3 * side**2 * share[i] * share[j] for i in top for j in top}
    draft.area("snow load", "snow", down)
    east = {name: force for name, force in down.items() if int(name[1]) > last // 2}
    draft.area("drift load", "drift", east)
    mm, strain = float(rng.uniform(0.05, 0.12)), float(rng.uniform(0.4, 1.0))
    for name in ("b00", "b11", "b12", "b21", "b22", "b33", "b03", "b30", "b13"):
        draft.moves(f"V {name}", name, [0, 0, 1], round(mm, 3))
    draft.moves("H E", f"t{last}2", [1, 0, 0], round(mm, 3))
    draft.moves("H N", f"t2{last}", [0, 1, 0], round(mm, 3))
    chords = ("b01-b11", "b11-b21", "b21-b31", "b11-b12", "b12-b22", "b02-b12")
    uppers = ("t12-t22", "t22-t32", "t21-t22", "t22-t23")
    webs = ("b00-t00", "b30-t40", "b03-t04", "b33-t44", "b11-t11", "b22-t33")
    for name in (*chords, *uppers, *webs):
        draft.strains(f"S {name}", name, round(strain, 3))
    return FieldStructure(
        name="roof",
        model=draft.model,
        moods={"air": ("air", 1.0), "snow": ("snow", 0.8), "drift": ("snow", 0.6)},
        depths={"chord": 0.05, "web": 0.038},
        loads=["snow load", "drift load"],
    )
