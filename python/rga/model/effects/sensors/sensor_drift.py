"""Sensors whose zero moves with time."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect, Values, seconds
from rga.model.effects.sensors.places import Sensors, each_sensor
from rga.model.effects.sensors.zero_offset import OFFSET_WORDS, offset_scale
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.readings import Readings
from rga.model.schema import Model

USUAL, DAYS = Normal(0.0, 1.0), 30


class SensorDrift(Effect):
    """An offset that grows from the first row, or from the onset [unit/day]."""

    kind: Literal["sensor_drift"] = "sensor_drift"
    action = Action(
        inspect="sensor {place}: moisture, adhesive, cable",
        check="its zero now and after some days, without load; replace it if it goes on",
    )
    usual = f"in {DAYS} days {USUAL} times a large offset ({OFFSET_WORDS}): a judgement"
    remembers = True
    keeps_past = True
    on_sensors = True
    sensor: Sensors
    rate: Annotated[Value, Parameter("unit/day", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"rate": USUAL.times(offset_scale(model, place["sensor"]) / DAYS)}

    def change_readings(self, readings: Readings, values: Values) -> None:
        time = readings.time
        if self.onset is None:
            days = (time - self.past.setdefault("first", time[:1].copy())) / 86400
        else:
            days = np.maximum(time - seconds(self.onset), 0.0) / 86400
        readings.values[:, readings.at(self.sensor)] += (values["rate"] * days)[:, None]
