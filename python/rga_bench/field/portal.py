"""A portal frame of a hall, with its roof's purlins as nodes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rga_bench.field.structure import FieldStructure, fibre, frame, pushes
from rga_bench.synthetic.bridges.model_draft import Draft, steel

_COLUMN, _RAFTER = 3, 4


def portal(rng: np.random.Generator) -> FieldStructure:
    """Columns fixed in their foundations, rafters rigid at eaves and ridge."""
    span, eaves = float(rng.uniform(18.0, 26.0)), float(rng.uniform(5.5, 8.0))
    rise, bay = 0.12 * span, 6.0
    sections = {
        "column": {"A": 0.0149, "Iy": 2.52e-4, "Iz": 8.6e-5, "J": 1.9e-6},
        "rafter": {"A": 0.0085, "Iy": 2.31e-4, "Iz": 1.3e-5, "J": 5.1e-7},
    }
    draft = Draft("portal frame", {"steel": steel(2.1e11)}, sections)
    draft.model["plane"] = "xz"
    for i in range(_COLUMN + 1):
        draft.node(f"w{i}", 0.0, 0.0, eaves * i / _COLUMN)
        draft.node(f"e{i}", span, 0.0, eaves * i / _COLUMN)
    inner = range(1, 2 * _RAFTER)
    for i in inner:
        height = rise * (1.0 - abs(i - _RAFTER) / _RAFTER)
        draft.node(f"r{i}", span * i / (2 * _RAFTER), 0.0, eaves + height)
    for i in range(_COLUMN):
        frame(draft, (f"w{i}", f"w{i + 1}"), "column", ["west column"])
        frame(draft, (f"e{i}", f"e{i + 1}"), "column", ["east column"])
    line = [f"w{_COLUMN}", *(f"r{i}" for i in inner), f"e{_COLUMN}"]
    for k, ends in enumerate(pairwise(line)):
        frame(draft, ends, "rafter", ["west rafter" if k < _RAFTER else "east rafter"])
    draft.support("west", "w0", "ux", "uz", "ry")
    draft.support("east", "e0", "ux", "uz", "ry")
    draft.context("air", "degC", -20, 45)
    draft.context("snow", "kPa", 0, 2.5)
    draft.context("wind", "kPa", -1.5, 1.5)
    groups = ("west column", "east column", "west rafter", "east rafter")
    draft.warmth("warmth", "air", 12.0, dict.fromkeys(groups, 1.0))
    piece = span / (2 * _RAFTER)
    down = {f"r{i}": 1e3 * bay * piece for i in inner}
    draft.area("snow load", "snow", down | dict.fromkeys((line[0], line[-1]), 5e2 * bay * piece))
    part = 1e3 * bay * eaves / _COLUMN
    wind = {f"w{i}": [0.8 * part * (0.5 if i == _COLUMN else 1.0), 0.0, 0.0] for i in (1, 2, 3)}
    wind |= {f"e{i}": [0.4 * part * (0.5 if i == _COLUMN else 1.0), 0.0, 0.0] for i in (1, 2, 3)}
    pushes(draft, "wind load", "wind", wind)
    mm, strain = float(rng.uniform(0.15, 0.4)), float(rng.uniform(0.8, 1.6))
    for node in ("r2", "r4", "r6"):
        draft.moves(f"V {node}", node, [0, 0, 1], round(mm, 3))
    for node in (line[0], line[-1], "r4", "w2", "e2"):
        draft.moves(f"H {node}", node, [1, 0, 0], round(mm, 3))
    for node in ("w1", "e1", line[0], line[-1]):
        draft.tilts(f"tilt {node}", node, [0, 1, 0], round(0.15 * mm, 4))
    for side in ("w", "e"):
        for face, z in (("out", 0.13), ("in", -0.13)):
            fibre(draft, f"{side} foot {face}", f"{side}0-{side}1", round(strain, 3), 0.2, z)
        fibre(draft, f"{side} eaves", f"{side}2-{side}3", round(strain, 3), 0.8, 0.13)
    for name, member in (("rafter w", "r1-r2"), ("ridge", "r3-r4"), ("rafter e", "r6-r7")):
        fibre(draft, f"{name} top", member, round(strain, 3), 0.5, 0.16)
        fibre(draft, f"{name} bottom", member, round(strain, 3), 0.5, -0.16)
    return FieldStructure(
        name="portal",
        model=draft.model,
        moods={"air": ("air", 1.0), "snow": ("snow", 0.5), "wind": ("wind", 0.35)},
        depths={"column": 0.13, "rafter": 0.165},
        loads=["snow load", "wind load"],
    )
