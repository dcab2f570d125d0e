"""Sensors whose scale is off."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import (
    MaybePoints,
    MaybeSensors,
    check_one_place,
    each_point,
    each_sensor,
)
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.readings import Readings
from rga.model.schema import Model

USUAL = Normal(1.0, 0.3)
#: an accelerometer that is turned, or dead, is no rarer than one that is a little off; a
#: screening looks at a dead one, and at one that reads half as much again
USUAL_AT_POINT = Normal(1.0, 1.0, trials=(-2.0, -1.0, 0.5))


class SensorGain(Effect):
    """A factor on a sensor; -1 is a wrong sign.

    Of a gauge (`sensor`), or of the accelerometer at a point (`point`): then on the shapes of all
    modes there, -1 where it is mounted the wrong way round.
    """

    kind: Literal["sensor_gain"] = "sensor_gain"
    action = Action(
        inspect="the fixing and the direction of the sensor {place}",
        check="its calibration factor, sign, bridge circuit and cable length; shunt calibration",
        test="read it beside a second sensor at the same place",
    )
    usual = f"factor {USUAL} of a gauge, {USUAL_AT_POINT} at a point: judgements"
    on_sensors = True
    sensor: MaybeSensors = None
    point: MaybePoints = None
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    def check(self, model: Model) -> None:
        check_one_place(self)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)
        yield from each_point(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL_AT_POINT if "point" in place else USUAL}

    def change_readings(self, readings: Readings, values: Values) -> None:
        columns = sum(readings.at_points(self.point), readings.at(self.sensor))
        readings.values[:, columns] *= values["factor"][:, None]
