"""Numbers and units as an engineer reads them: few digits, SI prefixes, intervals."""

import math
from collections.abc import Sequence

#: unit -> (smallest magnitude, factor, unit shown), the largest magnitude first
SCALES: dict[str, list[tuple[float, float, str]]] = {
    "N/m": [(1e9, 1e-9, "GN/m"), (1e6, 1e-6, "MN/m"), (1e3, 1e-3, "kN/m"), (0, 1, "N/m")],
    "N m/rad": [
        (1e9, 1e-9, "GN m/rad"),
        (1e6, 1e-6, "MN m/rad"),
        (1e3, 1e-3, "kN m/rad"),
        (0, 1, "N m/rad"),
    ],
    "N": [(1e6, 1e-6, "MN"), (1e3, 1e-3, "kN"), (0, 1, "N")],
    "N m": [(1e6, 1e-6, "MN m"), (1e3, 1e-3, "kN m"), (0, 1, "N m")],
    "Pa": [(1e9, 1e-9, "GPa"), (1e6, 1e-6, "MPa"), (1e3, 1e-3, "kPa"), (0, 1, "Pa")],
    "m": [(0.1, 1, "m"), (0, 1e3, "mm")],
    "m2": [(0.1, 1, "m²"), (1e-4, 1e4, "cm²"), (0, 1e6, "mm²")],
    "rad": [(0.1, 1, "rad"), (0, 1e3, "mrad")],
    "m/m": [(0, 1e6, "µm/m")],
    "strain": [(0, 1e6, "µm/m")],
    "microstrain": [(0, 1, "µm/m")],
    "-": [(0, 1, "")],
}
PRETTY = {"degC": "°C", "m3": "m³", "m4": "m⁴", "kg/m3": "kg/m³"}
#: percents beyond which nobody reads them as such
TIMES = 1000
NARROW, DASH, MINUS, MIDDLE_DOT = "\u202f", "\u2013", "\u2212", "\u00b7"
SUPERSCRIPT = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def number(value: float, digits: int = 3) -> str:
    """A number with so many significant digits.

    >>> number(0.012345), number(-134.2), number(2.4e9), number(float("nan"))
    ('0.0123', '\u2212134', '2.4·10⁹', '\u2013')
    """
    if not math.isfinite(value):
        return DASH if math.isnan(value) else ("∞" if value > 0 else MINUS + "∞")
    if value == 0:
        return "0"
    exponent = _exponent(value, digits)
    if not -4 <= exponent < 7:
        mantissa = f"{value / 10.0**exponent:.{digits - 1}f}".rstrip("0").rstrip(".")
        return f"{mantissa}·10{str(exponent).translate(SUPERSCRIPT)}".replace("-", MINUS)
    return fixed(value, max(digits - 1 - exponent, 0))


def short(value: float, digits: int = 3) -> str:
    """A number without trailing zeros, as on an axis.

    >>> short(10.0), short(0.004), short(12.34567)
    ('10', '0.004', '12.3')
    """
    text = number(value, digits)
    return text.rstrip("0").rstrip(".") if "." in text and MIDDLE_DOT not in text else text


def fixed(value: float, decimals: int, sign: bool = False) -> str:
    """A number with so many decimals, thousands apart by narrow spaces.

    >>> fixed(12345.6, 0), fixed(-0.04, 1), fixed(2.5, 1, sign=True)
    ('12\u202f346', '0.0', '+2.5')
    """
    if not math.isfinite(value):
        return number(value)
    value = round(value, decimals) + 0.0
    text = f"{value:{'+' if sign and value else ''},.{decimals}f}"
    if abs(value) < 10000:
        text = text.replace(",", "")
    return text.replace(",", NARROW).replace("-", MINUS)


def percent(value: float, sign: bool = True) -> str:
    """Percent: one decimal below ten; how many times as large where that says more.

    >>> percent(-31.4), percent(2.04), percent(99113.0)
    ('\u221231\xa0%', '+2.0\xa0%', '992\xa0times')
    """
    if not math.isfinite(value):
        return DASH
    if value > TIMES:
        # A signed one says by how much something is larger, one without a sign is a share of it.
        return fixed(value / 100 + sign, 0) + "\u00a0times"
    return fixed(value, 1 if abs(value) < 9.95 else 0, sign) + "\u00a0%"


def scale(unit: str, magnitude: float) -> tuple[float, str]:
    """Factor and unit in which values of a magnitude are shown.

    >>> scale("N/m", 2.4e7), scale("degC", 3.0)
    ((1e-06, 'MN/m'), (1.0, '°C'))
    """
    for smallest, factor, shown in SCALES.get(unit, []):
        if abs(magnitude) >= smallest:
            return float(factor), shown
    return 1.0, PRETTY.get(unit, unit)


def quantity(value: float, unit: str, ci90: Sequence[float] | None = None) -> str:
    """A value with its unit and, where known, its 90 % interval.

    >>> quantity(2.4e7, "N/m", (2.1e7, 2.8e7)).replace("\u00a0", " ")
    '24.0 MN/m [21.0, 28.0]'
    """
    factor, shown = scale(unit, value)
    after = f"\u00a0{shown}" if shown else ""
    if ci90 is None:
        return number(value * factor) + after
    low, high = (bound * factor for bound in ci90)
    half = (high - low) / 2
    shown_values = [number(one) for one in (value * factor, low, high)]
    if math.isfinite(half) and half > 0 and _exponent(half, 2) >= -4 and abs(value * factor) < 1e7:
        # The interval says which digits mean something: two of its half width are kept.
        decimals = max(1 - _exponent(half, 2), 0)
        shown_values = [fixed(one, decimals) for one in (value * factor, low, high)]
    return f"{shown_values[0]}{after} [{shown_values[1]}, {shown_values[2]}]"


def plain(text: str) -> str:
    """A text of a number that has no digits but 0 to 9, and nothing between them.

    Raises:
        ValueError: Python would take it for a number all the same, which nobody writes.

    >>> float(plain("1e3"))
    1000.0
    >>> plain("1_0")
    Traceback (most recent call last):
    ValueError: '1_0' is no number
    """
    if "_" in text or not text.isascii():
        raise ValueError(f"{text!r} is no number")
    return text


def counted(count: int, what: str) -> str:
    """A number of things.

    >>> counted(1, "row"), counted(2, "row")
    ('1 row', '2 rows')
    """
    return f"{count} {what}{'s' if count != 1 else ''}"


def bytes_in_words(size: float) -> str:
    """A number of bytes in the unit in which it is read best.

    >>> bytes_in_words(2.5e9), bytes_in_words(12e6)
    ('2.5 GB', '12 MB')
    """
    return f"{size / 1e9:.3g} GB" if size >= 1e9 else f"{size / 1e6:.3g} MB"


def duration(seconds: float) -> tuple[float, str]:
    """Seconds in the unit that suits a length of time, and the unit.

    >>> duration(36.7), duration(7200.0 * 299)[1]
    ((36.7, 's'), 'days')
    """
    for smallest, length, unit in (
        (3 * 86400, 86400, "days"),
        (3 * 3600, 3600, "h"),
        (900, 60, "min"),
    ):
        if seconds >= smallest:
            return seconds / length, unit
    return seconds, "s"


def _exponent(value: float, digits: int) -> int:
    """Power of ten of a value once it is rounded to so many digits."""
    return int(f"{abs(value):.{digits - 1}e}".split("e")[1])
