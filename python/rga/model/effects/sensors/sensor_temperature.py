"""Sensors that are not compensated for temperature."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import Sensors, each_sensor
from rga.model.effects.sensors.zero_offset import OFFSET_WORDS, offset_scale
from rga.model.effects.temperature.temperature import Temperature
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.readings import Readings
from rga.model.schema import Model

USUAL, KELVIN = Normal(0.0, 1.0), 30


class SensorTemperature(Effect):
    """A sensor that follows the temperature [unit/K]."""

    kind: Literal["sensor_temperature"] = "sensor_temperature"
    action = Action(
        inspect="whether sensor {place} stands in the sun",
        check="its temperature compensation (dummy gauge, half bridge)",
        test="a clear day without load",
    )
    usual = f"over {KELVIN} K {USUAL} times a large offset ({OFFSET_WORDS}): a judgement"
    on_sensors = True
    sensor: Sensors
    rate: Annotated[Value, Parameter("unit/K", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(isinstance(effect, Temperature) for effect in model.effects.values()):
            yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"rate": USUAL.times(offset_scale(model, place["sensor"]) / KELVIN)}

    def change_readings(self, readings: Readings, values: Values) -> None:
        readings.values[:, readings.at(self.sensor)] += (
            values["rate"] * readings.temperature_change
        )[:, None]
