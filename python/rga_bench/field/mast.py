"""A square lattice mast, guyed or standing free."""

from __future__ import annotations

import numpy as np

from rga_bench.field.structure import FieldStructure, pushes, tube
from rga_bench.synthetic.bridges.model_draft import Draft, steel

_BAYS = 5
_CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


def mast(rng: np.random.Generator) -> FieldStructure:
    """Legs run through; faces have one diagonal a bay."""
    guyed = rng.random() < 0.5
    bay = float(rng.uniform(4.0, 6.0))
    foot, top = (1.2, 1.2) if guyed else (float(rng.uniform(2.6, 3.6)), 1.2)
    leg, brace = tube(0.1397, 0.008), tube(0.0603, 0.004)
    sections = {"leg": leg, "brace": brace, "guy": {"A": 4.0e-4}}
    draft = Draft("guyed mast" if guyed else "lattice mast", {"steel": steel(2.1e11)}, sections)
    for level in range(_BAYS + 1):
        half = 0.5 * (foot + (top - foot) * level / _BAYS)
        for corner, (x, y) in enumerate(_CORNERS):
            draft.node(f"{level}{corner}", half * x, half * y, bay * level)
    for level in range(1, _BAYS + 1):
        for corner in range(4):
            following = (corner + 1) % 4
            legs = ["legs", f"bay {level}"]
            ends = (f"{level - 1}{corner}", f"{level}{corner}")
            draft.member(ends, "leg", legs, name=f"leg {level}{corner}", kind="frame")
            diagonal = (f"{level - 1}{corner}", f"{level}{following}")
            draft.member(diagonal, "brace", ["diagonals", f"bay {level}"])
            draft.member((f"{level}{corner}", f"{level}{following}"), "brace", ["horizontals"])
        draft.member((f"{level}0", f"{level}2"), "brace", ["horizontals"])
    for corner in range(4):
        draft.support(f"foot {corner}", f"0{corner}", "ux", "uy", "uz", "rz")
    groups = {"legs": 1.0, "diagonals": 1.0, "horizontals": 1.0}
    if guyed:
        reach = 3.0 * bay
        for corner, (x, y) in enumerate(_CORNERS):
            draft.node(f"anchor {corner}", reach * x, reach * y, 0.0)
            ends = (f"anchor {corner}", f"3{corner}")
            draft.member(ends, "guy", ["guys"], name=f"guy {corner}")
            draft.support(f"anchor {corner}", f"anchor {corner}", "ux", "uy", "uz")
        groups["guys"] = 1.0
    draft.context("air", "degC", -25, 45)
    draft.context("wind x", "kPa", -2, 2)
    draft.context("wind y", "kPa", -2, 2)
    draft.warmth("warmth", "air", 10.0, groups)
    area = 0.35 * bay  # of the members and cables that a level catches wind with [m2], a corner
    for axis, name in enumerate(("wind x", "wind y")):
        forces: dict[str, list[float]] = {}
        for level in range(1, _BAYS + 1):
            force = [0.0, 0.0, 0.0]
            force[axis] = 1e3 * area * (0.5 if level == _BAYS else 1.0)
            forces |= {f"{level}{corner}": force for corner in range(4)}
        pushes(draft, f"drag {name}", name, forces)
    mm, strain = float(rng.uniform(0.08, 0.2)), float(rng.uniform(0.5, 1.0))
    for level in (1, 2, 3, 4, 5):
        draft.moves(f"X{level}", f"{level}0", [1, 0, 0], round(mm, 3))
        draft.moves(f"Y{level}", f"{level}0", [0, 1, 0], round(mm, 3))
    draft.tilts("tilt x", f"{_BAYS}0", [1, 0, 0], round(0.2 * mm, 4))
    draft.tilts("tilt y", f"{_BAYS}0", [0, 1, 0], round(0.2 * mm, 4))
    for corner in range(4):
        draft.strains(f"G1{corner}", f"leg 1{corner}", round(strain, 3))
        draft.strains(f"G3{corner}", f"leg 3{corner}", round(strain, 3))
        draft.strains(f"D1{corner}", f"0{corner}-1{(corner + 1) % 4}", round(strain, 3))
        if guyed:
            draft.strains(f"T{corner}", f"guy {corner}", round(strain, 3))
    return FieldStructure(
        name="mast",
        model=draft.model,
        moods={"air": ("air", 1.0), "wind x": ("wind", 0.5), "wind y": ("wind", 0.35)},
        depths={"leg": 0.07, "brace": 0.03, "guy": 0.0},
        loads=["drag wind x", "drag wind y"],
    )
