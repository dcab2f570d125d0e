"""How far the zero of a sensor may be off."""

from rga.model.schema import Model
from rga.model.units import UNITS

#: a large zero offset of a sensor [SI unit], by kind of sensor
OFFSET = {"displacement": 5e-3, "rotation": 1e-3, "strain": 3e-5, "force": 2e4, "reaction": 2e4}
#: the same in words
OFFSET_WORDS = "5 mm, 1 mrad, 30 microstrain or 20 kN, by what the sensor measures"


def offset_scale(model: Model, sensor: str) -> float:
    """A large zero offset of a sensor in its own unit."""
    kind = model.sensors[sensor].kind
    return OFFSET[kind] * UNITS[kind][model.sensors[sensor].unit]
