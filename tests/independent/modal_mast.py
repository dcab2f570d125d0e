"""A lattice mast that swings: three legs alike, so that bending modes come in close pairs."""

from typing import Any

import numpy as np

BAYS, RADIUS = 9, 0.6
LEGS, FACES = "abc", ("ab", "bc", "ca")


def mast(_: str = "frame") -> dict[str, Any]:
    """The mast as a model file: a frame, whoever holds it."""
    nodes: dict[str, list[float]] = {}
    members: dict[str, dict[str, Any]] = {}

    def join(first: str, last: str, group: str) -> None:
        leg = group.startswith("leg")
        members[f"{first}-{last}"] = {
            "nodes": [first, last], "section": "leg" if leg else "brace", "material": "steel",
            "kind": "frame", "groups": [group],
        }  # fmt: skip

    for bay in range(BAYS + 1):
        for leg, angle in zip(LEGS, np.radians([90.0, 210.0, 330.0]), strict=True):
            x, y = RADIUS * np.cos(angle), RADIUS * np.sin(angle)
            nodes[f"{bay}{leg}"] = [float(x), float(y), float(bay)]
    for bay in range(BAYS):
        for leg in LEGS:
            join(f"{bay}{leg}", f"{bay + 1}{leg}", f"leg {leg}")
        for one, other in FACES:
            join(f"{bay}{one}", f"{bay + 1}{other}", f"braces {bay}")
            join(f"{bay + 1}{one}", f"{bay + 1}{other}", "rings")
    axes = {"x": [1, 0, 0], "y": [0, 1, 0]}
    return {
        "rga_model": 1,
        "name": "mast",
        "materials": {"steel": {"E": 2.1e11, "nu": 0.3, "density": 7850.0}},
        "sections": {
            "leg": {"A": 3e-4, "Iy": 3e-8, "Iz": 3e-8, "J": 6e-8},
            "brace": {"A": 6e-5, "Iy": 4e-10, "Iz": 4e-10, "J": 8e-10},
        },
        "nodes": nodes,
        "members": members,
        "supports": {
            f"foot {leg}": {"node": f"0{leg}", "fixed": ["ux", "uy", "uz", "rx", "ry", "rz"]}
            for leg in LEGS
        },
        "masses": {f"top {leg}": {"node": f"{BAYS}{leg}", "mass": 10.0} for leg in LEGS},
        "points": {
            f"{bay}{leg} {axis}": {"node": f"{bay}{leg}", "direction": axes[axis]}
            for bay in (2, 4, 6, 8, 9)
            for leg, axis in (("a", "x"), ("a", "y"), ("b", "y"))
        },
    }  # fmt: skip
