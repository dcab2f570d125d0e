"""Two trusses on which every kind of effect shows, and its contexts."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.model import Model, read_model
from rga.simulation import Simulator

HOUR = 3600.0


ROWS = 24


#: Contexts of the small bridge, float[rows] each; `knob` drives the parameter under test.
ROW = np.arange(ROWS)


CONTEXTS: dict[str, NDArray[np.float64]] = {
    "time": HOUR * ROW,
    "temperature": 12 + 9 * np.sin(0.7 * ROW),
    "crowd": 20 + 15 * np.cos(1.3 * ROW),
    "cart": 4 + 3.5 * np.sin(1.9 * ROW),
    "wind": 100 * np.cos(0.9 * ROW) ** 2,
    "knob": np.ones(ROWS),
}


def bridge(**effects: Any) -> Model:
    """Two pinned trusses of two panels, 4 m apart, with girders and a stringer that bend."""
    nodes = {
        f"{name}{side}": [x, y, z]
        for side, y in (("s", -2.0), ("n", 2.0))
        for name, x, z in (("a", 0, 0), ("b", 4, 0), ("c", 8, 0), ("t", 4, 3))
    }
    pinned = {
        "bottom": ["as-bs", "bs-cs", "an-bn", "bn-cn"],
        "webs": ["as-ts", "ts-cs", "an-tn", "tn-cn", "bs-ts", "bn-tn"],
        "bracing": ["as-bn", "an-bs", "bs-cn", "bn-cs", "bs-tn", "bn-ts", "ts-tn"],
    }
    members = {
        bar: {"nodes": bar.split("-"), "section": "bar", "material": "steel", "groups": [group]}
        for group, bars in pinned.items()
        for bar in bars
    }
    for girder in ("as-an", "bs-bn", "cs-cn"):
        members[girder] = {
            "nodes": girder.split("-"),
            "section": "girder",
            "material": "iron",
            "kind": "frame",
            "groups": ["floor"],
            "releases": {"i": ["rx"], "j": ["rx"]},
        }
    for first, last in ("ab", "bc"):
        members[f"stringer {first}{last}"] = {
            "nodes": [f"{first}s", f"{last}s"],
            "section": "girder",
            "material": "iron",
            "kind": "frame",
            "groups": ["stringer"],
        }
    down = {"unit": "mm", "kind": "displacement"}
    content = {
        "rga_model": 1,
        "name": "every kind",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}, "iron": {"E": 1e11, "alpha": 1e-5}},
        "sections": {
            "bar": {"A": 0.004, "Iy": 4e-6, "Iz": 4e-6, "J": 1e-6},
            "girder": {"A": 0.01, "Iy": 8e-5, "Iz": 6e-5, "J": 1e-5},
        },
        "nodes": nodes,
        "members": members,
        "supports": {
            "A": {"node": "as", "fixed": ["ux", "uy", "uz"]},
            "B": {"node": "an", "fixed": ["ux", "uz"]},
            "C": {"node": "cs", "fixed": ["uy", "uz"]},
            "D": {"node": "cn", "fixed": ["uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40]},
            "crowd": {"unit": "kN", "range": [0, 50]},
            "cart": {"unit": "m", "range": [0, 8]},
            "wind": {"unit": "Pa", "range": [0, 500]},
            "knob": {"unit": "-", "range": [0.5, 1.5]},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {
                    "bottom": 1.0,
                    "webs": 0.8,
                    "bracing": 1.2,
                    "floor": 1.0,
                    "stringer": 1.0,
                },
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "people": {
                "kind": "nodal_load",
                "forces": {"bs": [0, 0, -800], "bn": [0, 300, -600]},
                "factor": {"context": "crowd"},
            },
            "cart": {
                "kind": "axle_load",
                "path": ["as", "bs", "cs"],
                "forces": [3e4, 2e4],
                "offsets": [0.0, 1.0],
                "position": {"context": "cart"},
            },
            "tank": {"kind": "nodal_load", "forces": {"tn": [500, 0, -2e4]}},
            "snow": {
                "kind": "member_load",
                "member": ["bs-bn", "as-an"],
                "uniform": [0, 500, -2e3],
            },
            **effects,
        },
        "sensors": {
            "D1": {**down, "node": "bs", "direction": [0, 0, 1]},
            "D2": {**down, "node": "tn", "direction": [0, 1, 0]},
            "D3": {**down, "node": "cs", "direction": [1, 0, 0]},
            "D4": {**down, "node": "cn", "direction": [1, 0, 0]},
            "S1": {"kind": "strain", "member": "as-bs", "unit": "microstrain"},
            "S2": {"kind": "strain", "member": "bs-bn", "unit": "microstrain", "y": 0.1},
            "S3": {"kind": "strain", "member": "bs-tn", "unit": "microstrain"},
            "F1": {"kind": "force", "member": "an-tn", "unit": "kN"},
            "R1": {"kind": "reaction", "node": "an", "direction": [0, 0, 1], "unit": "kN"},
            "T1": {"kind": "rotation", "node": "bn", "direction": [1, 0, 0], "unit": "mrad"},
        },
    }
    return read_model(content, "test")


def readings(model: Model, **changes: Any) -> NDArray[np.float64]:
    return Simulator(model).predict({**CONTEXTS, **changes})
