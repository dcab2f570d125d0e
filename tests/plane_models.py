"""Plane models of one material, and parts of them, for tests of large displacements."""

from typing import Any

import rga
from rga.model import read_model

E, ALPHA = 2e11, 1.2e-5
FIXED = ["ux", "uy", "uz", "rx", "ry", "rz"]


def model(**parts: Any) -> rga.Model:
    """A model of one material, its geometry nonlinear unless said otherwise."""
    return read_model(
        {
            "rga_model": 1,
            "name": "geometry",
            "plane": "xz",
            "materials": {"steel": {"E": E, "nu": 0.25, "alpha": ALPHA, "density": 7850}},
            "analysis": {"geometry": "nonlinear"},
            **parts,
        },
        "model",
    )


def force(nodes: dict[str, list[float]], context: str) -> dict[str, Any]:
    return {"kind": "nodal_load", "forces": nodes, "factor": {"context": context}}


def moves(node: str, direction: list[float]) -> dict[str, Any]:
    return {"kind": "displacement", "node": node, "direction": direction, "unit": "m"}


def reacts(node: str, direction: list[float]) -> dict[str, Any]:
    return {"kind": "reaction", "node": node, "direction": direction, "unit": "N"}
