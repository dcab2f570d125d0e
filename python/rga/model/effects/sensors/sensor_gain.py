"""Sensors whose scale is off."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import Sensors, each_sensor
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.readings import Readings
from rga.model.schema import Model

USUAL = Normal(1.0, 0.3)


class SensorGain(Effect):
    """A factor on a sensor; -1 is a wrong sign."""

    kind: Literal["sensor_gain"] = "sensor_gain"
    action = Action(
        inspect="the fixing of sensor {place}",
        check="its calibration factor, sign, bridge circuit and cable length; shunt calibration",
        test="read it beside a second sensor at the same place",
    )
    usual = f"factor {USUAL}: a judgement"
    on_sensors = True
    sensor: Sensors
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL}

    def change_readings(self, readings: Readings, values: Values) -> None:
        readings.values[:, readings.at(self.sensor)] *= values["factor"][:, None]
