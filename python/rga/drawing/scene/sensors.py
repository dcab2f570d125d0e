"""Where sensors sit and in which direction they measure."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.loads import LoadMark
from rga.drawing.scene.scene import Scene


@dataclass(frozen=True)
class SensorMark:
    """A sensor.

    Attributes:
        name, kind, unit: as in the model.
        point: where it sits on the axis of a member, or at a node, float[3] [m].
        direction: in which it measures, float[3] of length one; along the member for a gauge.
        side: from the axis of the member to the fibre, float[3] of length one or zeros.
        member, node: number of what it sits on; the other is None.
        place: 0 for the first sensor at a place, 1 for the second...
        ahead: a load comes to the node in about this direction, from where the symbol would stand.
    """

    name: str
    kind: str
    unit: str
    point: FloatArray
    direction: FloatArray
    side: FloatArray
    member: int | None
    node: int | None
    place: int
    ahead: bool


def sensor_marks(scene: Scene, loads: Sequence[LoadMark]) -> list[SensorMark]:
    """The sensors of a model, in its order, where these loads are drawn too."""
    found: list[SensorMark] = []
    taken: dict[tuple[object, ...], int] = {}
    for name, sensor in scene.model.sensors.items():
        side = np.zeros(3)
        if sensor.member is not None and sensor.kind in ("strain", "force"):
            member: int | None = scene.members[sensor.member]
            node = None
            axes = scene.axes[scene.members[sensor.member]]
            point = scene.along(scene.members[sensor.member], sensor.at)
            direction = axes[0]
            off = sensor.y * axes[1] + sensor.z * axes[2]
            if np.linalg.norm(off) > 0:
                side = off / np.linalg.norm(off)
        else:
            assert sensor.node is not None  # by the schema
            assert sensor.direction is not None
            member, node = None, scene.nodes[sensor.node]
            point = scene.points[node]
            direction = np.array(sensor.direction) / np.linalg.norm(sensor.direction)
        turns = sensor.kind == "rotation"
        key = (member, node, round(sensor.at, 3), turns, *np.round(side, 1), *np.round(direction))
        place = taken[key] = taken.get(key, -1) + 1
        found.append(
            SensorMark(
                name=name,
                kind=sensor.kind,
                unit=sensor.unit,
                point=point,
                direction=direction,
                side=side,
                member=member,
                node=node,
                place=place,
                ahead=any(_pushes(load, node, direction) for load in loads),
            )
        )
    return found


def _pushes(load: LoadMark, node: int | None, direction: FloatArray) -> bool:
    forces = load.forces[load.nodes == node] if node is not None else np.zeros((0, 3))
    return bool((forces @ direction > 0.8 * np.linalg.norm(forces, axis=1)).any())
