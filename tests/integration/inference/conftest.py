"""A plane truss of six panels, as its model says and as it is."""

import json

import numpy as np
import pytest

from rga.inference import Unknowns
from rga.model import Model, read_model


@pytest.fixture(scope="module")
def model() -> Model:
    """A plane truss of six panels with two latent contexts and vertical displacements."""
    panels, nodes, members = 6, {}, {}
    for i in range(panels + 1):
        nodes[f"L{i}"] = [4.0 * i, 0, 0]
        nodes[f"U{i}"] = [4.0 * i, 0, 4.0]

    def add(one: str, other: str, group: str) -> None:
        bar = {"nodes": [one, other], "section": "bar", "material": "steel", "groups": [group]}
        members[f"{one}-{other}"] = {**bar, "kind": "truss"}

    for i in range(panels):
        add(f"L{i}", f"L{i + 1}", "bottom chord")
        add(f"U{i}", f"U{i + 1}", "top chord")
        add(f"L{i}", f"U{i + 1}", "diagonals")
    for i in range(panels + 1):
        add(f"L{i}", f"U{i}", "verticals")
    forces = {f"L{i}": [0, 0, -2e4] for i in range(1, panels)}
    lean = {f"L{i}": [0, 0, -1e4 * i] for i in range(1, panels)}
    sensors = {
        f"{node} {way}": {
            "kind": "displacement",
            "node": node,
            "direction": direction,
            "unit": "mm",
            "noise": 0.02,
        }
        for node in nodes
        for way, direction in (("z", [0, 0, 1]), ("x", [1, 0, 0]))
        if node not in ("L0", f"L{panels}")
    }
    groups = {m["groups"][0]: 1.0 for m in members.values()}
    content = {
        "rga_model": 1,
        "name": "six panels",
        "plane": "xz",
        "materials": {"steel": {"E": 2.0e11, "nu": 0.3, "alpha": 1.2e-5, "density": 7850}},
        "sections": {"bar": {"A": 0.004, "Iy": 8e-6, "Iz": 8e-6, "J": 1e-6}},
        "nodes": nodes,
        "members": members,
        "supports": {
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": f"L{panels}", "fixed": ["uz"]},
        },
        "context": {
            "crowd": {"unit": "kPa", "range": [0, 4]},
            "lean": {"unit": "-", "range": [0, 1]},
            "warmth": {"unit": "K", "range": [-20, 20]},
            "bearing": {"unit": "log10 N/m", "range": [6, 8]},
        },
        "effects": {
            "load": {"kind": "nodal_load", "forces": forces, "factor": {"context": "crowd"}},
            "more": {"kind": "nodal_load", "forces": lean, "factor": {"context": "lean"}},
            "warm": {"kind": "temperature", "groups": groups, "delta": {"context": "warmth"}},
            "spring": {
                "kind": "support_spring",
                "support": "east",
                "dof": "ux",
                "stiffness": {"context": "bearing", "log10": True},
            },
        },
        "sensors": sensors,
    }
    return read_model(json.loads(json.dumps(content)), "six panels")


@pytest.fixture(scope="module")
def other(model: Model) -> Model:
    """The structure as it is: a softer bottom chord, a stiffer stretch of diagonals."""
    unknowns = Unknowns(model)
    values = unknowns.centre.copy()
    names = [part.name for part in unknowns.parts]
    values[names.index("stiffness of bottom chord")] = np.log10(0.85)
    values[names.index("stiffness of diagonals")] = np.log10(1.1)
    return unknowns.at(values)
