"""Plane models of one material, parts of them, and rows of contexts and readings of a model."""

from typing import Any

import numpy as np

import rga
from rga.arrays import FloatArray
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


def drawn(model: rga.Model, rows: int, seed: int) -> FloatArray:
    """Contexts spread evenly over their ranges."""
    low, high = np.array([one.range for one in model.context.values()]).T
    return np.asarray(low + (high - low) * np.random.default_rng(seed).random((rows, len(low))))


def measured(model: rga.Model, contexts: FloatArray, seed: int) -> FloatArray:
    """Readings of contexts, with the noise of `noise_of`."""
    clean = rga.Simulator(model).predict(dict(zip(model.context, contexts.T, strict=True)))
    return np.asarray(clean + 0.02 * np.random.default_rng(seed).standard_normal(clean.shape))


def noise_of(model: rga.Model) -> FloatArray:
    """Standard deviation of each sensor's noise."""
    return np.full(len(model.sensors), 0.02)
