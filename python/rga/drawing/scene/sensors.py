"""Where sensors sit and in which direction they measure."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
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


def sensor_marks(scene: Scene) -> list[SensorMark]:
    """The sensors of a model, in its order."""
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
            SensorMark(name, sensor.kind, sensor.unit, point, direction, side, member, node, place)
        )
    return found
