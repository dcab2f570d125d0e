"""A truss that a cart crosses, a crowd on it, its temperature measured."""

import numpy as np

from rga.model import read_model
from rga.model.schema import Model

LATENT = ("crowd", "cart")


def crossed_truss(*, both_ways: bool) -> Model:
    """A truss of four panels under temperature (measured), a crowd and a cart.

    Args:
        both_ways: the cart may come from either end, else from the first alone.
    """
    bar = {"section": "bar", "material": "steel", "groups": ["all"]}
    low = {f"L{k}": [3.0 * k, 0, 0] for k in range(5)}
    high = {f"U{k}": [3.0 * k, 0, 2.5] for k in range(1, 4)}
    chords = [(f"L{k}", f"L{k + 1}") for k in range(4)] + [("U1", "U2"), ("U2", "U3")]
    web = [("L0", "U1"), ("U1", "L2"), ("L2", "U3"), ("U3", "L4"), *zip(
        ("L1", "L2", "L3"), ("U1", "U2", "U3"), strict=True)]  # fmt: skip
    members = {f"{i}-{j}": {"nodes": [i, j], **bar} for i, j in chords + web}
    strains = {
        f"S {name}": {"kind": "strain", "member": name, "unit": "microstrain", "noise": 2.0}
        for name in members
    }
    moved = {
        f"D {node}": {
            "kind": "displacement",
            "node": node,
            "direction": [0, 0, 1],
            "unit": "mm",
            "noise": 0.1,
        }
        for node in ("L1", "L2", "L3")
    }
    roller = {"node": "L4", "kind": "displacement", "direction": [1, 0, 0]}
    content = {
        "rga_model": 1,
        "name": "truss",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.002}},
        "nodes": {**low, **high},
        "members": members,
        "supports": {
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": "L4", "fixed": ["uz"]},
        },
        "context": {
            "crowd": {"unit": "kN", "range": [0, 20]},
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.3},
            "cart": {
                "unit": "m",
                "range": [0.5, 11.5],
                "law": "linear",
                "rate": [-2 if both_ways else 0, 2],
            },
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"all": 1.0},
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "people": {
                "kind": "nodal_load",
                "forces": {f"L{k}": [0, 0, -1000] for k in range(1, 4)},
                "factor": {"context": "crowd"},
            },
            "axles": {
                "kind": "axle_load",
                "path": list(low),
                "forces": [60e3, 20e3],
                "offsets": [0.0, 1.5],
                "position": {"context": "cart"},
            },
        },
        "sensors": {**strains, **moved, "D end": {**roller, "unit": "mm", "noise": 0.1}},
    }
    return read_model(content, "test")


def noise_of(model: Model) -> np.ndarray:
    return np.array([*(s.noise or 0.0 for s in model.sensors.values()), 0.3])
