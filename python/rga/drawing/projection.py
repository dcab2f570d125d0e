"""The views in which a bridge is drawn: an elevation per truss, and a plan of what is left."""

from dataclasses import dataclass

import numpy as np

from rga.model.schema import Model, Sensor
from rga.quantities import MINUS

LETTERS = "xyz"
MOST_VIEWS = 4


@dataclass(frozen=True)
class Projection:
    """A drawing of part of the bridge.

    Attributes:
        title: in words.
        axes: coordinates that run to the right and upwards.
        members, nodes: what is drawn.
    """

    title: str
    axes: tuple[int, int]
    members: tuple[str, ...]
    nodes: frozenset[str]

    def holds(self, sensor: Sensor) -> bool:
        """Whether the sensor's place is drawn here."""
        if sensor.member is not None:
            return sensor.member in self.members
        return sensor.node in self.nodes


def views(model: Model, also: set[str]) -> list[Projection]:
    """The views of a model.

    Args:
        model: the model.
        also: members that must be seen even if no sensor is on them.
    """
    points = np.array(list(model.nodes.values()))
    extent = np.ptp(points, axis=0)
    if model.plane == "xy":
        return [_whole(model, "plan", (0, 1))]
    right = int(np.argmax(extent[:2]))
    if model.plane is not None:
        right = LETTERS.index(model.plane[0])
    depth = 1 - right
    if extent[2] < 0.02 * extent[right]:
        return [_whole(model, "plan", (right, depth))]
    whole = _whole(model, "elevation", (right, 2))
    if extent[depth] < 1e-6:
        return [whole]
    trusses = _trusses(model, right, depth, float(extent[right]), float(extent[depth]))
    covered = [any(view.holds(sensor) for view in trusses) for sensor in model.sensors.values()]
    if not trusses or sum(covered) < 0.5 * len(covered):
        # Inclined trusses, towers: everything is seen from the side.
        return [whole]
    drawn = {member for view in trusses for member in view.members}
    if not all(covered) or also - drawn:
        trusses.append(_whole(model, "plan", (right, depth)))
    return trusses


def _whole(model: Model, title: str, axes: tuple[int, int]) -> Projection:
    return Projection(title, axes, tuple(model.members), frozenset(model.nodes))


def _trusses(model: Model, right: int, depth: int, length: float, width: float) -> list[Projection]:
    levels: dict[int, list[str]] = {}
    step = 0.01 * width
    for name, member in model.members.items():
        first, last = (round(model.nodes[node][depth] / step) for node in member.nodes)
        if first == last:
            levels.setdefault(first, []).append(name)
    found = []
    for level, members in sorted(levels.items()):
        nodes = [node for name in members for node in model.members[name].nodes]
        reach = np.ptp([model.nodes[node][right] for node in nodes])
        if len(members) >= 3 and reach >= 0.5 * length:
            place = model.nodes[nodes[0]][depth]
            title = f"elevation at {LETTERS[depth]} = {place:.4g} m".replace("-", MINUS)
            view = Projection(title, (right, 2), tuple(members), frozenset(nodes))
            number = sum(view.holds(sensor) for sensor in model.sensors.values())
            found.append((number, len(members), level, view))
    best = sorted(found, key=lambda item: item[:2], reverse=True)[:MOST_VIEWS]
    return [view for *_, view in sorted(best, key=lambda item: item[2])]
