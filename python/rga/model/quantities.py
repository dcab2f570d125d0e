"""Values of parameters in words."""

from collections.abc import Mapping
from typing import Any

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
#: units whose large values read better with a prefix
SCALED = ("N/m", "N m/rad", "N")


def value_words(value: Any, unit: str) -> str:
    """A value as it stands in a model file, with its interval and unit, three digits.

    >>> value_words({"value": 2.4e7, "ci90": [2.1e7, 2.8e7]}, "N/m")
    '24 [21, 28] MN/m'
    """
    if isinstance(value, Mapping) and "value" in value:
        low, high = value["ci90"]
        scale, prefix = _prefix(abs(value["value"]), unit)
        shown = f"{value['value'] / scale:.3g} [{low / scale:.3g}, {high / scale:.3g}]"
    elif isinstance(value, int | float):
        scale, prefix = _prefix(abs(value), unit)
        shown = f"{value / scale:.3g}"
    else:
        return str(value)
    if unit in ("-", "unit", ""):
        return shown
    # That of a sensor's effect is counted in the sensor's own unit.
    return f"{shown} {prefix}{unit.replace('unit/', 'per ')}"


def _prefix(size: float, unit: str) -> tuple[float, str]:
    if unit in SCALED:
        for scale, prefix in PREFIXES:
            if size >= scale:
                return scale, prefix
    return 1.0, ""
