"""What the sensors show: the simulated channels as effects on sensors change them."""

from dataclasses import dataclass, field

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
        modes: columns of the sensors of each mode by the point that they read; "": its frequency.
    """

    values: FloatArray
    columns: dict[str, int]
    time: FloatArray
    temperature_change: FloatArray
    modes: dict[str, dict[str, int]] = field(default_factory=dict)

    def at(self, sensors: str | list[str]) -> list[int]:
        """Columns of the sensors of a place."""
        return [self.columns[name] for name in listed(sensors)]
