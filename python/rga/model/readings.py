"""What the sensors show: the simulated channels as effects on sensors change them."""

from dataclasses import dataclass

from rga.arrays import FloatArray
from rga.model.parameter import listed


@dataclass
class Readings:
    """Simulated channels on their way to the logger.

    Attributes:
        values: float[rows, sensors] in the units of the sensors.
        columns: sensor -> column.
        time: float[rows] [s].
        temperature_change: temperature change of each sensor's surroundings, float[rows] [K].
    """

    values: FloatArray
    columns: dict[str, int]
    time: FloatArray
    temperature_change: FloatArray

    def at(self, sensors: str | list[str]) -> list[int]:
        """Columns of the sensors of a place."""
        return [self.columns[name] for name in listed(sensors)]
