"""Sensors that do not work."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import MaybePoints, MaybeSensors, check_one_place
from rga.model.parameter import listed
from rga.model.readings import Readings
from rga.model.schema import Model


def is_fault(effect: Mapping[str, Any]) -> bool:
    """Whether an effect, as in a model file, is a channel that does not work.

    >>> is_fault({"kind": "sensor_fault", "sensor": "S1", "mode": "dead"})
    True
    """
    return effect.get("kind") == "sensor_fault"


def channel_words(effect: Mapping[str, Any]) -> str:
    """The channel that an effect, as in a model file, says does not work.

    >>> channel_words({"kind": "sensor_fault", "point": "A1", "mode": "dead"})
    'point A1'
    """
    return " and ".join(
        [*listed(effect.get("sensor")), *(f"point {one}" for one in listed(effect.get("point")))]
    )


class SensorFault(Effect):
    """A sensor that does not work: its channel says nothing.

    A gauge (`sensor`), or the accelerometer at a point (`point`): then no shape has a motion there,
    whatever a record holds. A diagnosis looks for these before it proposes effects of other kinds.

    Attributes:
        mode: it shows nothing (dead), stands still (stuck), jumps away now and then (spiking),
            goes ways of its own (erratic), holds the readings of another channel (copy), or
            answers many times too much or too little (scale).
    """

    kind: Literal["sensor_fault"] = "sensor_fault"
    action = Action(
        inspect="the sensor {place}: cable, connector, amplifier",
        check="replace it, or leave the channel out",
    )
    on_sensors = True
    sensor: MaybeSensors = None
    point: MaybePoints = None
    mode: Literal["dead", "stuck", "spiking", "erratic", "copy", "scale"]

    def check(self, model: Model) -> None:
        check_one_place(self)

    def change_readings(self, readings: Readings, values: Values) -> None:
        faulty = np.flatnonzero(self.weight(readings.time) > 0)
        columns = sum(readings.at_points(self.point), readings.at(self.sensor))
        readings.values[faulty[:, None], columns] = np.nan

    @classmethod
    def size_words(cls, effect: Mapping[str, Any]) -> str:
        return f" ({effect['mode']})" if "mode" in effect else ""
