"""Sensors whose cables are exchanged."""

from collections.abc import Iterator
from itertools import combinations
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import check_one_place
from rga.model.parameter import Place
from rga.model.readings import Readings
from rga.model.schema import Model


class SensorSwap(Effect):
    """Two sensors whose cables are exchanged.

    Two gauges (`sensors`), or the accelerometers at two points (`points`): then the shape of every
    mode has at each the motion of the other.
    """

    kind: Literal["sensor_swap"] = "sensor_swap"
    action = Action(
        check="the channels {place} at the logger: their plugs or names are exchanged",
        test="touch or warm one sensor and see which channel moves",
    )
    on_sensors = True
    sensors: Annotated[tuple[str, str] | None, Place("sensor")] = None
    points: Annotated[tuple[str, str] | None, Place("point")] = None

    def check(self, model: Model) -> None:
        check_one_place(self, "sensors", "points")
        for name, (first, second) in self.place.items():
            if first == second:
                raise ValueError(f"{name}: name two that differ")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for first, second in combinations(model.sensors, 2):
            if model.sensors[first].unit == model.sensors[second].unit:
                yield {"sensors": (first, second)}
        yield from ({"points": pair} for pair in combinations(model.points, 2))

    def change_readings(self, readings: Readings, values: Values) -> None:
        swapped = np.flatnonzero(self.weight(readings.time) > 0)[:, None]
        pairs = [readings.at(self.sensors_named()), *readings.at_points(self.points_named())]
        for pair in pairs:
            if len(pair) == 2:
                readings.values[swapped, pair] = readings.values[swapped, pair[::-1]]
