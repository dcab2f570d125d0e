"""Sensors that do not work."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.places import Sensors
from rga.model.readings import Readings


def is_fault(effect: Mapping[str, Any]) -> bool:
    """Whether an effect, as in a model file, is a channel that does not work.

    >>> is_fault({"kind": "sensor_fault", "sensor": "S1", "mode": "dead"})
    True
    """
    return effect.get("kind") == "sensor_fault"


class SensorFault(Effect):
    """A sensor that does not work: its channel says nothing.

    A diagnosis looks for these before it proposes effects of other kinds.

    Attributes:
        mode: it shows nothing (dead), stands still (stuck), jumps away now and then (spiking),
            goes ways of its own (erratic), holds the readings of another channel (copy), or
            answers many times too much or too little (scale).
    """

    kind: Literal["sensor_fault"] = "sensor_fault"
    action = Action(
        inspect="sensor {place}: cable, connector, amplifier",
        check="replace it, or leave the channel out",
    )
    on_sensors = True
    sensor: Sensors
    mode: Literal["dead", "stuck", "spiking", "erratic", "copy", "scale"]

    def change_readings(self, readings: Readings, values: Values) -> None:
        faulty = np.flatnonzero(self.weight(readings.time) > 0)
        readings.values[faulty[:, None], readings.at(self.sensor)] = np.nan

    @classmethod
    def size_words(cls, effect: Mapping[str, Any]) -> str:
        return f" ({effect['mode']})" if "mode" in effect else ""
