"""Sensors that do not show what they should."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.bending import bending_axes
from rga.model.effect import Effect, Values, seconds
from rga.model.parameter import Normal, Parameter, Place, Prior, Value, listed
from rga.model.readings import Readings
from rga.model.schema import Model
from rga.model.structure import Structure
from rga.model.units import UNITS

Sensors = Annotated[str | list[str], Place("sensor")]
#: a large zero offset of a sensor [SI unit], by kind
OFFSET = {"displacement": 5e-3, "rotation": 1e-3, "strain": 3e-5, "force": 2e4, "reaction": 2e4}

#: how far off its fibre a gauge may sit [m]: half the depth of a common rolled section, from one
#: of its flanges to its axis
OFF_FIBRE = 0.15


class SensorBias(Effect):
    """A constant offset of a sensor [its unit]."""

    kind: Literal["sensor_bias"] = "sensor_bias"
    on_sensors = True
    sensor: Sensors
    offset: Annotated[Value, Parameter("unit", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"offset": Normal(0.0, offset_scale(model, place["sensor"]))}

    def change_readings(self, readings: Readings, values: Values) -> None:
        readings.values[:, readings.at(self.sensor)] += values["offset"][:, None]


class SensorGain(Effect):
    """A factor on a sensor; -1 is a wrong sign."""

    kind: Literal["sensor_gain"] = "sensor_gain"
    on_sensors = True
    sensor: Sensors
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Normal(1.0, 0.3)}

    def change_readings(self, readings: Readings, values: Values) -> None:
        readings.values[:, readings.at(self.sensor)] *= values["factor"][:, None]


class SensorDrift(Effect):
    """An offset that grows from the first row, or from the onset [unit/day]."""

    kind: Literal["sensor_drift"] = "sensor_drift"
    remembers = True
    on_sensors = True
    sensor: Sensors
    rate: Annotated[Value, Parameter("unit/day", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"rate": Normal(0.0, offset_scale(model, place["sensor"]) / 30)}

    def change_readings(self, readings: Readings, values: Values) -> None:
        days = readings.days
        if self.onset is not None and len(days):
            days = np.maximum(readings.time - seconds(self.onset), 0.0) / 86400
        readings.values[:, readings.at(self.sensor)] += (values["rate"] * days)[:, None]


class SensorFault(Effect):
    """A sensor that does not work: its channel says nothing.

    Attributes:
        mode: it shows nothing (dead), stands still (stuck), jumps away now and then (spiking),
            goes ways of its own (erratic), holds the readings of another channel (copy), or
            answers many times too much or too little (scale).
    """

    kind: Literal["sensor_fault"] = "sensor_fault"
    on_sensors = True
    sensor: Sensors
    mode: Literal["dead", "stuck", "spiking", "erratic", "copy", "scale"]

    def change_readings(self, readings: Readings, values: Values) -> None:
        faulty = np.flatnonzero(self.weight(readings.time) > 0)
        readings.values[faulty[:, None], readings.at(self.sensor)] = np.nan


class SensorSwap(Effect):
    """Two sensors whose cables are exchanged."""

    kind: Literal["sensor_swap"] = "sensor_swap"
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


class SensorTemperature(Effect):
    """A sensor that follows the temperature [unit/K]."""

    kind: Literal["sensor_temperature"] = "sensor_temperature"
    on_sensors = True
    sensor: Sensors
    rate: Annotated[Value, Parameter("unit/K", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(effect.kind == "temperature" for effect in model.effects.values()):
            yield from each_sensor(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"rate": Normal(0.0, offset_scale(model, place["sensor"]) / 30)}

    def change_readings(self, readings: Readings, values: Values) -> None:
        readings.values[:, readings.at(self.sensor)] += (values["rate"] * readings.warmth)[:, None]


class GaugePosition(Effect):
    """A strain gauge off the fibre where the model has it: it reads other bending [m]."""

    kind: Literal["gauge_position"] = "gauge_position"
    structural = True
    sensor: Sensors
    y: Annotated[Value, Parameter("m", 0.0)] = 0.0
    z: Annotated[Value, Parameter("m", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        joints = {
            name
            for effect in model.effects.values()
            if effect.kind == "joint_rigidity"
            for group in [getattr(effect, "group")]  # noqa: B009
            for one in ([group] if isinstance(group, str) else group)
            for name in model.groups[one]
        }
        for name, sensor in model.sensors.items():
            if sensor.kind != "strain" or sensor.member is None:
                continue
            if sensor.member in joints or model.members[sensor.member].kind == "frame":
                yield {"sensor": name}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        (sensor,) = listed(place["sensor"])[:1]
        bent = bending_axes(model, str(model.sensors[sensor].member))
        return {axis: Normal(0.0, OFF_FIBRE) for axis in bent}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        # A simulation may be asked for other sensors than those of the model: member forces, say.
        asked = [name for name in listed(self.sensor) if name in structure.sensors]
        rows = [structure.sensors[name] for name in asked]
        structure.outputs["vector"][rows, 1:] += value["y"], value["z"]


def each_sensor(model: Model) -> Iterator[dict[str, Any]]:
    """Every sensor as a place."""
    yield from ({"sensor": sensor} for sensor in model.sensors)


def offset_scale(model: Model, sensor: str) -> float:
    """A large zero offset of a sensor in its own unit."""
    kind = model.sensors[sensor].kind
    return OFFSET[kind] * UNITS[kind][model.sensors[sensor].unit]
