"""Sensors whose cables are exchanged."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.parameter import Place
from rga.model.readings import Readings
from rga.model.schema import Model


class SensorSwap(Effect):
    """Two sensors whose cables are exchanged."""

    kind: Literal["sensor_swap"] = "sensor_swap"
    action = Action(
        check="the channels {place} at the logger: their plugs or names are exchanged",
        test="touch or warm one sensor and see which channel moves",
    )
    on_sensors = True
    sensors: Annotated[tuple[str, str], Place("sensor")]

    def check(self, model: Model) -> None:
        if len(set(self.sensors)) < 2:
            raise ValueError("sensors: name two that differ")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        names = list(model.sensors)
        for number, first in enumerate(names):
            for second in names[number + 1 :]:
                if model.sensors[first].unit == model.sensors[second].unit:
                    yield {"sensors": (first, second)}

    def change_readings(self, readings: Readings, values: Values) -> None:
        swapped = self.weight(readings.time) > 0
        first, second = (readings.values[:, readings.columns[name]].copy() for name in self.sensors)
        for name, shown in zip(self.sensors, (second, first), strict=True):
            readings.values[swapped, readings.columns[name]] = shown[swapped]
