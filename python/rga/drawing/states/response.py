"""Displacements and forces of a structure at given contexts, by way of sensors everywhere."""

from collections.abc import Mapping

from rga.arrays import FloatArray
from rga.model.schema import Model, Sensor
from rga.simulation import Simulator

AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def node_displacements(model: Model, contexts: Mapping[str, float]) -> FloatArray:
    """Displacements [m] and rotations [rad] of all nodes, float[nodes, 6].

    Args:
        contexts: of one row, every one that the model needs.

    Raises:
        InputError: a context is missing or not finite.
        UnstableStructureError: the structure can move; names node and direction.
    """
    sensors = {
        f"{kind} {axis} {node}": Sensor(kind=kind, node=node, direction=direction, unit=unit)
        for node in model.nodes
        for kind, unit in (("displacement", "m"), ("rotation", "rad"))
        for axis, direction in enumerate(AXES)
    }
    return _read(model, sensors, contexts).reshape(len(model.nodes), 6)


def axial_forces(model: Model, contexts: Mapping[str, float], positions: FloatArray) -> FloatArray:
    """Axial forces of all members [N], tension positive, float[members, stations].

    Args:
        contexts: as for `node_displacements`, with the same errors.
        positions: of the stations as shares of each member's length, float[members, stations].
    """
    sensors = {
        f"force {station} {name}": Sensor(kind="force", member=name, at=float(at), unit="N")
        for name, stations in zip(model.members, positions, strict=True)
        for station, at in enumerate(stations)
    }
    return _read(model, sensors, contexts).reshape(positions.shape)


def _read(model: Model, sensors: dict[str, Sensor], contexts: Mapping[str, float]) -> FloatArray:
    # Effects on the model's own sensors say nothing of the structure, and go with these.
    found: FloatArray = Simulator(model.with_sensors(sensors)).predict(contexts)[0]
    return found
