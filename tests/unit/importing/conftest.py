"""What tests of importers share: how an imported model moves, and how a slow solver says so."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from independent.reference_solver import Frame
from rga.model import Model, Sensor
from rga.simulation import Simulator

AXES = ("x", "y", "z")


@pytest.fixture
def moves() -> Callable[[Model], dict[str, list[float]]]:
    """Displacements and rotations of every node of a model under its loads [m, rad]."""

    def of(model: Model) -> dict[str, list[float]]:
        sensors = {}
        for node in model.nodes:
            for kind, unit in (("displacement", "m"), ("rotation", "rad")):
                for k, axis in enumerate(AXES):
                    sensors[f"{node} {kind} {axis}"] = Sensor(
                        kind=kind,
                        unit=unit,
                        node=node,
                        direction=tuple(np.eye(3)[k].tolist()),
                    )
        readings = Simulator(model.with_sensors(sensors)).predict({}).ravel().tolist()
        return {node: readings[6 * place : 6 * place + 6] for place, node in enumerate(model.nodes)}

    return of


@pytest.fixture
def solved() -> Callable[..., dict[str, list[float]]]:
    """Displacements and rotations of every node of a case, by the solver of the tests."""

    def of(case: dict[str, Any], **loads: Any) -> dict[str, list[float]]:
        frame = Frame({"supports": [], **case}, loads)
        motions, _ = frame.solve()
        return {
            node: [float(value) for value in motions[first : first + 6]]
            for node, first in frame.first.items()
        }

    return of


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str, str], Path]:
    """Writes a file of a name."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write
