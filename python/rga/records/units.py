"""Units as people and loggers write them, and what turns a value into the model's unit."""

import re
from dataclasses import dataclass
from functools import cache

from rga.errors import InputError
from rga.model import Model

#: dimensions in which the unit of a sensor of this kind may be written; a slope in mm/m is an angle
#: as long as it is small
DIMENSIONS = {
    "displacement": ("length",),
    "rotation": ("angle", "ratio"),
    "strain": ("ratio",),
    "force": ("force",),
    "reaction": ("force",),
}
#: prefixes and their factors (BIPM, The International System of Units, table 7)
_PREFIXES = {"": 1.0, "n": 1e-9, "u": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}
#: dimension -> symbol -> its size in the coherent unit of the dimension, and prefixes it may have
_SYMBOLS: dict[str, dict[str, tuple[float, str]]] = {
    "length": {
        "m": (1.0, "num"), "km": (1e3, ""), "dm": (0.1, ""), "cm": (1e-2, ""), "um": (1e-6, ""),
        "in": (0.0254, ""), "ft": (0.3048, ""), "mil": (2.54e-5, ""),
    },
    "angle": {
        "rad": (1.0, "um"), "deg": (0.017453292519943295, "m"), "gon": (0.015707963267948967, "m"),
        "arcsec": (4.84813681109536e-6, ""), "arcmin": (2.908882086657216e-4, ""),
    },
    "ratio": {
        "m/m": (1.0, "num"), "strain": (1.0, "num"), "mm/mm": (1.0, ""), "eps": (1.0, "um"),
        "e": (1.0, "u"), "um/mm": (1e-3, ""), "ppm": (1e-6, ""), "%": (1e-2, ""), "-": (1.0, ""),
        "permille": (1e-3, ""), "percent": (1e-2, ""), "%rh": (1e-2, ""), "in/in": (1.0, "u"),
        "unitless": (1.0, ""),
    },
    "force": {
        "N": (1.0, "mkM"), "lbf": (4.4482216152605, ""), "kip": (4448.2216152605, ""),
        "kgf": (9.80665, ""), "kp": (9.80665, ""), "tf": (9806.65, ""), "dyn": (1e-5, ""),
    },
    "pressure": {
        "Pa": (1.0, "kMG"), "N/m2": (1.0, "kM"), "N/mm2": (1e6, "k"), "N/cm2": (1e4, "k"),
        "bar": (1e5, "m"), "hPa": (100.0, ""), "psi": (6894.757293168, ""),
        "ksi": (6894757.293168, ""), "atm": (101325.0, ""), "psf": (47.88025898, ""),
    },
    "mass": {"g": (1e-3, "mku"), "t": (1e3, "k"), "lb": (0.45359237, ""), "to": (1e3, "")},
    "time": {"s": (1.0, "num"), "min": (60.0, ""), "h": (3600.0, ""), "d": (86400.0, "")},
    "moment": {"Nm": (1.0, "mkM"), "lbft": (1.3558179483314, ""), "kipft": (1355.8179483314, "")},
    "force on length": {"N/m": (1.0, "kM"), "N/mm": (1e3, "k"), "lbf/ft": (14.5939029372, "")},
    "speed": {
        "m/s": (1.0, "m"), "km/h": (1 / 3.6, ""), "mph": (0.44704, ""),
    },
    "acceleration": {"m/s2": (1.0, "um"), "gal": (1e-2, "m"), "g0": (9.80665, "um")},
    "voltage": {"V": (1.0, "umk")},
    "voltage ratio": {"V/V": (1.0, "um"), "mV/V": (1e-3, "")},
    "current": {"A": (1.0, "um")},
    "resistance": {"Ohm": (1.0, "mkM")},
    "frequency": {"Hz": (1.0, "mkMG"), "rpm": (1 / 60, "")},
    "power on area": {"W/m2": (1.0, "k")},
}  # fmt: skip
#: a temperature in kelvin is size * value + offset
_TEMPERATURES = {"K": (1.0, 0.0), "degC": (1.0, 273.15), "degF": (5 / 9, 459.67 * 5 / 9)}
#: words that stand for a symbol, in whatever case they are written
_WORDS = {
    "microstrain": "ustrain", "microstrains": "ustrain", "ustr": "ustrain",
    "millistrain": "mstrain",
    "microe": "ue", "microm/m": "um/m", "micro m/m": "um/m", "mikrom/m": "um/m", "uepsilon": "ue",
    "strains": "strain", "mue": "ue", "mum/m": "um/m", "µ strain": "ustrain", "microeps": "ueps",
    "c": "degC", "oc": "degC", "deg c": "degC", "degc": "degC", "celsius": "degC", "deg.c": "degC",
    "grad c": "degC", "gradc": "degC", "degrees c": "degC", "degree celsius": "degC",
    "degrees celsius": "degC", "degcelsius": "degC", "deg_c": "degC",
    "f": "degF", "of": "degF", "deg f": "degF", "degf": "degF", "fahrenheit": "degF",
    "kelvin": "K", "degk": "K", "k": "K", "deg k": "K",
    "degrees": "deg", "degree": "deg", "grad": "deg", "radian": "rad", "radians": "rad",
    "meter": "m", "metre": "m", "meters": "m", "metres": "m", "millimeter": "mm",
    "millimetre": "mm", "millimeters": "mm", "millimetres": "mm", "centimeter": "cm",
    "micron": "um", "microns": "um", "inch": "in", "inches": "in", '"': "in", "feet": "ft",
    "newton": "N", "newtons": "N", "kilonewton": "kN", "kilonewtons": "kN", "kips": "kip",
    "lbs": "lb", "pounds": "lb", "pascal": "Pa", "kilogram": "kg", "kilograms": "kg",
    "tonne": "t", "tonnes": "t", "tons": "t",
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sekunde": "s", "sekunden": "s",
    "sek": "s", "msec": "ms", "usec": "us", "minutes": "min", "minute": "min", "hour": "h",
    "hours": "h", "hr": "h", "hrs": "h", "day": "d", "days": "d", "tage": "d",
    "volt": "V", "volts": "V", "ampere": "A", "amps": "A", "ohms": "Ohm", "hertz": "Hz",
    "none": "-", "1": "-", "/": "-", "cel": "degC", "": "-", "adim": "-", "[-]": "-",
    "promille": "permille",
    "percent rh": "%rh", "% rh": "%rh", "%r.h.": "%rh", "% r.h.": "%rh", "meters/second": "m/s",
}  # fmt: skip
_SIGNS = {
    "µ": "u", "μ": "u", "°": "deg", "º": "deg", "²": "2", "³": "3", "^": "", "·": "", "⋅": "",
    "*": "", "Ω": "Ohm", "\u2126": "Ohm", "ε": "eps", "ϵ": "eps", "‰": "permille", "″": "arcsec",
    "′": "arcmin", "**": "", "℃": "degC", "℉": "degF", "\u00a0": " ",
}  # fmt: skip
#: what stands where a unit would, and states none
_NO_UNIT = {"", "-", "--", "---", "\u2013", "\u2014", "\u2212", "n/a", "na", "none", "nan", "null"}
#: letters of a name of a column that are looked through for a unit: it takes their square
LONGEST_NAME = 1000
_BRACKETS = {"(": ")", "[": "]", "<": ">", "{": "}"}


@dataclass(frozen=True)
class Unit:
    """A unit: a value in it is `size * value + offset` in the coherent unit of its dimension."""

    dimension: str
    size: float
    offset: float = 0.0


@cache
def unit_of(text: str) -> Unit | None:
    """The unit that a text states, in whatever way it is written; None where it is unknown.

    >>> unit_of("µm/m") == unit_of("um/m") == unit_of("microstrain") == unit_of("[µε]")
    True
    >>> unit_of("kN/m²"), unit_of("Deg C")
    (Unit(dimension='pressure', size=1000.0, offset=0.0), Unit(dimension='temperature', size=1.0, \
offset=273.15))
    >>> unit_of("furlong") is None
    True
    """
    symbol = without_brackets(text)
    for sign, letters in _SIGNS.items():
        symbol = symbol.replace(sign, letters)
    symbol = " ".join(symbol.split())
    known = _known()
    for one in (symbol, symbol.replace(" ", ""), _WORDS.get(symbol.lower(), "")):
        if one in known:
            return known[one]
    # Capitals tell mN from MN; where they tell nothing apart, they are let go.
    alike = {known[one] for one in known if one.lower() == symbol.replace(" ", "").lower()}
    return alike.pop() if len(alike) == 1 else None


def states_none(text: str) -> bool:
    """Whether a text in the place of a unit states none.

    A dash is no unit: a strain that is a plain number is in m/m or "strain".

    >>> states_none("-"), states_none("[-]"), states_none("n/a"), states_none("m/m")
    (True, True, True, False)
    """
    return without_brackets(text).lower() in _NO_UNIT


def contradict(unit: str, other: str) -> bool:
    """Whether two statements of one unit are of different units that are both known.

    >>> contradict("µm/m", "mm/m"), contradict("µm/m", "um/m"), contradict("-", "mm")
    (True, False, False)
    """
    if states_none(unit) or states_none(other) or without_brackets(unit).isdigit():
        return False
    known = unit_of(unit), unit_of(other)
    return None not in known and known[0] != known[1]


def without_brackets(text: str) -> str:
    """A text without the brackets about it.

    >>> without_brackets(" [kN] "), without_brackets("(m)"), without_brackets("-")
    ('kN', 'm', '-')
    """
    text = text.strip()
    if len(text) > 1 and _BRACKETS.get(text[0]) == text[-1]:
        return text[1:-1].strip()
    return text


def name_and_unit(column: str) -> tuple[str, str | None]:
    """Name and unit of a column whose unit stands in brackets behind its name.

    What stands in round brackets is a unit only if it is one that is known.

    >>> name_and_unit("Kraft [kN]"), name_and_unit("MS1 [µm/m] CH=4"), name_and_unit("temp(1)")
    (('Kraft', 'kN'), ('MS1', 'µm/m'), ('temp(1)', None))
    """
    if len(column) > LONGEST_NAME:
        return column, None
    found = re.fullmatch(r"(?P<name>.*?\S)\s*(\[(?P<unit>[^]]+)\]|\((?P<round>[^)]+)\))"
                         r"(\s+CH=\S+)?", column.strip())  # fmt: skip
    if found is None or "," in column:
        # HOBO loggers write "Temp, °C (LGR S/N: 123)".
        parts = re.fullmatch(r"(?P<name>[^,]+), (?P<unit>[^,(]+?)( \(.*\))?", column.strip())
        if parts is not None and unit_of(parts["unit"]) is not None:
            return parts["name"], parts["unit"]
    if found is None:
        return column, None
    if found["unit"] is not None:
        return found["name"], found["unit"].strip()
    said = found["round"].strip()
    if said.isdigit() or unit_of(said) is None:
        return column, None
    return found["name"], said


def conversion(unit: str, name: str, model: Model, where: str) -> tuple[float, float]:
    """Factor and offset that turn a value in a unit into the model's of a sensor or context.

    Args:
        unit: as it is written.
        name: of the sensor or context variable.
        where: the file and the column, for an error.

    Raises:
        InputError: the unit is unknown, or is none of what is measured.

    Example: `conversion("degF", "temperature", model, "r.csv")` is (0.5556, -17.78) where the model
    has its temperature in degC.
    """
    sensor = model.sensors.get(name)
    wanted = sensor.unit if sensor else model.context[name].unit
    if unit == wanted:
        return 1.0, 0.0
    given, target = unit_of(unit), unit_of(wanted)
    kind = f"a {sensor.kind} sensor" if sensor else "that context variable"
    state = f'state it: {name} = {{ unit = "{wanted}" }} under [channels] in import.toml'
    if given is None:
        raise InputError(f"the unit {unit!r} of {name!r} is unknown", where, state)
    allowed = DIMENSIONS[sensor.kind] if sensor else ((target.dimension,) if target else ())
    if given.dimension not in allowed or target is None:
        raise InputError(
            f"the unit {unit!r} of {name!r} is not one of {kind}",
            where,
            f"convert it to {wanted}, or {state}",
        )
    return given.size / target.size, (given.offset - target.offset) / target.size


@cache
def _known() -> dict[str, Unit]:
    """Every symbol, with every prefix that it may have."""
    units = {
        symbol: Unit("temperature", size, offset)
        for symbol, (size, offset) in _TEMPERATURES.items()
    }
    for dimension, symbols in _SYMBOLS.items():
        for symbol, (size, prefixes) in symbols.items():
            for prefix in ("", *prefixes):
                units.setdefault(prefix + symbol, Unit(dimension, size * _PREFIXES[prefix]))
    return units
