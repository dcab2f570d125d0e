"""Values of parameters in words."""

from collections.abc import Mapping
from typing import Any

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
#: units whose large values read better with a prefix
SCALED = ("N/m", "N m/rad", "N")
#: units whose values below a tenth read better in thousandths
SMALL = ("m", "rad")

#: digits that a value is shown with, fewer than
MOST_DIGITS = 7


def value_words(value: Any, unit: str) -> str:
    """A value as it stands in a model file, with its interval and unit.

    Three digits, or as many as show the width of the interval.

    >>> value_words({"value": 2.4e7, "ci90": [2.1e7, 2.8e7]}, "N/m")
    '24 [21, 28] MN/m'
    >>> value_words({"value": 1.00321, "ci90": [1.00212, 1.00423]}, "-")
    '1.003 [1.002, 1.004]'
    >>> value_words(-0.0123, "m"), value_words(0.5, "m")
    ('-12.3 mm', '0.5 m')
    """
    if isinstance(value, Mapping) and "value" in value:
        low, high = value["ci90"]
        scale, prefix = _prefix(abs(value["value"]), unit)
        three = [number / scale for number in (value["value"], low, high)]
        digits = next(
            (k for k in range(3, MOST_DIGITS) if f"{three[1]:.{k}g}" != f"{three[2]:.{k}g}"), 3
        )
        shown = "{0:.{3}g} [{1:.{3}g}, {2:.{3}g}]".format(*three, digits)
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
    return (1e-3, "m") if unit in SMALL and 0 < size < 0.1 else (1.0, "")
