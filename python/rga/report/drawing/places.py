"""Where sensors, and what causes name, stand in a drawing."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rga.drawing.projection import Projection
from rga.model.effect import Effect
from rga.model.schema import Model


@dataclass(frozen=True)
class Named:
    """Parts of the model that causes name."""

    members: frozenset[str]
    nodes: frozenset[str]


def named_parts(effects: Iterable[dict[str, Any]], model: Model) -> Named:
    """Members and supported nodes that effects have as their place."""
    members: set[str] = set()
    nodes: set[str] = set()
    for effect in effects:
        for of, name in place_names(effect):
            if of == "member" and name in model.members:
                members.add(name)
            elif of == "group":
                members.update(model.groups.get(name, []))
            elif of == "support" and name in model.supports:
                nodes.add(model.supports[name].node)
            elif of == "node" and name in model.nodes:
                nodes.add(name)
            elif of == "point" and name in model.points:
                nodes.add(model.points[name].node)
    return Named(frozenset(members), frozenset(nodes))


def place_names(effect: dict[str, Any]) -> list[tuple[str, str]]:
    """The place of an effect as pairs: what sort of part, its name."""
    kind = Effect.vocabulary.get(str(effect.get("kind")))
    fields = {} if kind is None else {k: mark.of for k, mark in kind.place_fields().items()}
    found: list[tuple[str, str]] = []
    for field, of in fields.items():
        value = effect.get(field)
        if value is None:
            continue
        names = value if isinstance(value, list | tuple) else [value]
        found.extend((of or field, str(name)) for name in names)
    return found


@dataclass
class Spot:
    """A place in a view with the sensors that stand there.

    Attributes:
        x, y: in the coordinates of the view [m].
        side: where the label goes: "below", "above" or "right".
        tier: 1 beside a member, 2 farther out beside a node.
        member: the member that the sensors are on, if any.
        sensors: numbers of the sensors in the record.
    """

    x: float
    y: float
    side: str
    tier: int
    member: str | None
    sensors: list[int]


def spots(model: Model, view: Projection, sensors: dict[int, str]) -> list[Spot]:
    """Sensors of a view by place; sensors that share a place share a spot."""
    right, up = view.axes
    heights = [model.nodes[node][up] for node in view.nodes]
    middle = (min(heights) + max(heights)) / 2
    flat = max(heights) - min(heights) < 1e-9
    found: dict[tuple[str, str], Spot] = {}
    for column, name in sensors.items():
        sensor = model.sensors[name]
        if sensor.member is not None:
            ends = np.array([model.nodes[node] for node in model.members[sensor.member].nodes])
            point = ends[0] + sensor.at * (ends[1] - ends[0])
            run, rise = np.abs(ends[1] - ends[0])[[right, up]]
            side = "right" if rise > 0.3 * run else _side(point[up], middle, flat)
            key = ("member", sensor.member)
            spot = Spot(point[right], point[up], side, 1, sensor.member, [])
        else:
            assert sensor.node is not None
            x, y = model.nodes[sensor.node][right], model.nodes[sensor.node][up]
            key = ("node", sensor.node)
            spot = Spot(x, y, _side(y, middle, flat), 2, None, [])
        found.setdefault(key, spot).sensors.append(column)
    return list(found.values())


def _side(height: float, middle: float, flat: bool) -> str:
    return "below" if flat or height <= middle else "above"
