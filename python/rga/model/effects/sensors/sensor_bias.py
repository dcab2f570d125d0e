"""Sensors whose zero is off."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import Sensors, each_sensor
from rga.model.effects.sensors.zero_offset import OFFSET_WORDS, offset_scale
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.readings import Readings
from rga.model.schema import Model

USUAL = Normal(0.0, 1.0)


class SensorBias(Effect):
    """A constant offset of a sensor [its unit]."""

    kind: Literal["sensor_bias"] = "sensor_bias"
    action = Action(
        inspect="the fixing of sensor {place}",
        check="its zero: read it without load and set it again",
    )
    usual = f"offset {USUAL} times a large one ({OFFSET_WORDS}): a judgement"
    on_sensors = True
    sensor: Sensors
    offset: Annotated[Value, Parameter("unit", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"offset": USUAL.times(offset_scale(model, place["sensor"]))}

    def change_readings(self, readings: Readings, values: Values) -> None:
        readings.values[:, readings.at(self.sensor)] += values["offset"][:, None]
