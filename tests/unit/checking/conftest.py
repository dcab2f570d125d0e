"""A portal frame of which no check has anything to say, and a record of it."""

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
import pytest

from rga.model import Model, read_model
from rga.records import Record
from rga.simulation import Simulator


@pytest.fixture
def portal() -> dict[str, Any]:
    """A model file: a braced portal frame under temperature, wind and a cart."""
    frame = {"section": "I", "material": "steel", "kind": "frame", "groups": ["frame"]}
    return {
        "rga_model": 1,
        "name": "portal",
        "plane": "xz",
        "materials": {
            "steel": {"E": 2.1e11, "alpha": 1.2e-5, "density": 7850, "yield_strength": 2.35e8}
        },
        "sections": {
            "I": {
                "A": 0.0078,
                "Iy": 5.7e-5,
                "Iz": 2.0e-5,
                "J": 6e-7,
                "fibres": {"top": [0.0, 0.1], "bottom": [0.0, -0.1]},
            },
            "rod": {"A": 0.001},
        },
        "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [3, 0, 4], "D": [6, 0, 4], "E": [6, 0, 0]},
        "members": {
            "west": {"nodes": ["A", "B"], **frame},
            "beam 1": {"nodes": ["B", "C"], **frame},
            "beam 2": {"nodes": ["C", "D"], **frame},
            "east": {"nodes": ["E", "D"], **frame},
            "rod": {"nodes": ["A", "C"], "section": "rod", "material": "steel", "groups": ["rods"]},
        },
        "supports": {
            "west": {"node": "A", "fixed": ["ux", "uz", "ry"]},
            "east": {"node": "E", "fixed": ["ux", "uz"]},
        },
        "context": {
            "air": {"unit": "degC", "range": [-20, 40], "noise": 0.2},
            "wind": {"unit": "kN", "range": [0, 10], "noise": 0.05},
            "cart": {"unit": "m", "range": [-1, 7], "noise": 0.01},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"frame": 1.0, "rods": 0.9},
                "delta": {"context": "air", "minus": 10.0},
            },
            "wind": {
                "kind": "nodal_load",
                "forces": {"B": [1000, 0, 0]},
                "factor": {"context": "wind"},
            },
            "cart": {
                "kind": "axle_load",
                "path": ["B", "C", "D"],
                "forces": [8000.0, 8000.0],
                "offsets": [0.0, 0.5],
                "carried_by": "members",
                "position": {"context": "cart"},
            },
        },
        "sensors": {
            "U": _displacement("B", [1, 0, 0]),
            "V": _displacement("C", [0, 0, 1]),
            "W": _displacement("D", [1, 0, 0]),
            "S": _strain("beam 1", z=0.1),
            "T": _strain("west", z=0.1),
            "rod": _strain("rod"),
        },
    }


def _displacement(node: str, direction: list[int]) -> dict[str, Any]:
    return {
        "kind": "displacement",
        "node": node,
        "direction": direction,
        "unit": "mm",
        "noise": 0.02,
    }


def _strain(member: str, **place: float) -> dict[str, Any]:
    return {"kind": "strain", "member": member, "unit": "microstrain", "noise": 0.5, **place}


@pytest.fixture
def model(portal: dict[str, Any]) -> Model:
    """The portal frame."""
    return read_model(portal, "portal.json")


@pytest.fixture
def measured(model: Model) -> Callable[..., Record]:
    """A record of the portal frame: the simulator's own, with noise."""

    def record(rows: int = 200, start: str | float = 0.0, **changed: Any) -> Record:
        draw = np.random.default_rng(5)
        contexts = {
            "air": 10 + 12 * np.sin(np.arange(rows) / 20) + draw.random(rows),
            "wind": 8 * draw.random(rows),
            "cart": -1 + 8 * draw.random(rows),
        }
        time = 600.0 * np.arange(rows)
        readings = Simulator(model).predict({"time": time, **contexts})
        noise = np.array([sensor.noise for sensor in model.sensors.values()], dtype=float)
        readings = readings + noise * draw.standard_normal(readings.shape)
        told = {
            name: column + (model.context[name].noise or 0.0) * draw.standard_normal(rows)
            for name, column in contexts.items()
        }
        kind: Literal["iso", "seconds"] = "iso" if isinstance(start, str) else "seconds"
        given: dict[str, Any] = {"readings": readings, "contexts": told, "time": time, **changed}
        return Record(start=start, time_format=kind, sensors=tuple(model.sensors), **given)

    return record
