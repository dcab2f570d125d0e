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

    def at(self, sensors: str | list[str] | None) -> list[int]:
        """Columns of the sensors of a place."""
        return [self.columns[name] for name in listed(sensors)]

    def at_points(self, points: str | list[str] | None) -> list[list[int]]:
        """Columns of the shape of each mode, at those points of a place where it is read."""
        named = listed(points)
        return [[own[point] for point in named if point in own] for own in self.modes.values()]
