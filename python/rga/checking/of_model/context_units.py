"""Units of contexts that are not known, or that the effects which they drive cannot take."""

from collections.abc import Iterator

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.model.effect import Effect
from rga.model.parameter import Driven
from rga.model.schema import ContextVariable

#: unit -> what it measures, and its size in the SI unit of that
KNOWN: dict[str, tuple[str, float]] = {
    **dict.fromkeys(("K", "degC", "deg C", "°C", "C", "celsius"), ("temperature", 1.0)),
    **dict.fromkeys(("degF", "deg F", "°F", "F", "fahrenheit"), ("temperature", 5 / 9)),
    **dict.fromkeys(("m", "metre", "meter"), ("length", 1.0)),
    "mm": ("length", 1e-3), "cm": ("length", 1e-2), "km": ("length", 1e3),
    "ft": ("length", 0.3048), "in": ("length", 0.0254),
    "N": ("force", 1.0), "kN": ("force", 1e3), "MN": ("force", 1e6), "lbf": ("force", 4.448222),
    "kip": ("force", 4448.222),
    "N/m": ("force per length", 1.0), "kN/m": ("force per length", 1e3),
    "MN/m": ("force per length", 1e6), "N/mm": ("force per length", 1e3),
    "N/m2": ("pressure", 1.0), "N/m²": ("pressure", 1.0), "Pa": ("pressure", 1.0),
    "kN/m2": ("pressure", 1e3), "kN/m²": ("pressure", 1e3), "kPa": ("pressure", 1e3),
    "MPa": ("pressure", 1e6), "N/mm2": ("pressure", 1e6), "N/mm²": ("pressure", 1e6),
    "kg/m2": ("mass per area", 1.0), "kg/m²": ("mass per area", 1.0),
    "kg": ("mass", 1.0), "t": ("mass", 1e3), "kg/m": ("mass per length", 1.0),
    "N m": ("moment", 1.0), "Nm": ("moment", 1.0), "kN m": ("moment", 1e3), "kNm": ("moment", 1e3),
    "N m/rad": ("turning stiffness", 1.0), "kN m/rad": ("turning stiffness", 1e3),
    "m/s": ("speed", 1.0), "km/h": ("speed", 1 / 3.6), "mph": ("speed", 0.44704),
    "rad": ("angle", 1.0), "mrad": ("angle", 1e-3), "deg": ("angle", 0.01745329251994),
    "°": ("angle", 0.01745329251994),
    "s": ("time", 1.0), "min": ("time", 60.0), "h": ("time", 3600.0), "d": ("time", 86400.0),
    "m2": ("area", 1.0), "m²": ("area", 1.0),
    "W/m2": ("radiation", 1.0), "W/m²": ("radiation", 1.0),
    **dict.fromkeys(("-", "", "1"), ("number", 1.0)), "%": ("number", 0.01),
}  # fmt: skip
#: unit of a parameter -> what it measures; a factor takes whatever its load is given for
WANTED = {
    "K": "temperature",
    "m": "length",
    "rad": "angle",
    "N/m": "force per length",
    "N m/rad": "turning stiffness",
    "N": "force",
    "m2": "area",
}
#: kelvin and degrees Celsius, by the values that air and sun give
COLDEST_KELVIN, HOTTEST_CELSIUS = 200.0, 120.0
KELVIN, CELSIUS = "K", ("degC", "deg C", "°C", "C", "celsius")


def context_units(over: OverRanges) -> Iterator[Finding]:
    """Unknown units, units that an effect cannot take, kelvin that look like degrees Celsius."""
    model = over.model
    unknown = [name for name, one in model.context.items() if one.unit not in KNOWN]
    for name in unknown:
        yield Finding(
            "note",
            parts("context", [name]),
            f"the unit {model.context[name].unit!r} is not known here, so that what it drives "
            "cannot be checked",
            "check 'times' of the parameters that it drives, or write a unit such as degC, kN, m",
        )
    for name, variable in model.context.items():
        yield from _temperature(name, variable)
    for name, effect in model.effects.items():
        for key, driven in _driven(effect):
            variable = model.context[driven.context]
            # Slopes about a kink carry the unit from the one to the other.
            if driven.log10 or driven.kink is not None or variable.unit not in KNOWN:
                continue
            unit = type(effect).unit(key, effect.place)
            if unit in WANTED:
                yield from _taken(f"effect {name!r}, {key}", unit, driven, variable)


def _driven(effect: Effect) -> Iterator[tuple[str, Driven]]:
    for key in effect.parameters():
        value = getattr(effect, key)
        if isinstance(value, Driven):
            yield key, value


def _temperature(name: str, variable: ContextVariable) -> Iterator[Finding]:
    low, high = variable.range
    where = parts("context", [name])
    if variable.unit == KELVIN and low < COLDEST_KELVIN < 273.0 and high < HOTTEST_CELSIUS:
        what = f"its range {low:g} to {high:g} K looks like degrees Celsius"
        yield Finding("warning", where, what, "write degC, or the range in kelvin")
    if variable.unit in CELSIUS and low > HOTTEST_CELSIUS:
        what = f"its range {low:g} to {high:g} degC looks like kelvin"
        yield Finding("warning", where, what, "write K, or the range in degC")


def _taken(where: str, unit: str, driven: Driven, variable: ContextVariable) -> Iterator[Finding]:
    """What is wrong with a parameter that follows a context as times * (context - minus)."""
    of, size = KNOWN[variable.unit]
    if of != WANTED[unit]:
        # A factor 'times' may carry the unit from the one to the other.
        plain = driven.times == 1.0 or of == "temperature" or unit == "K"
        if plain and of != "number":
            yield Finding(
                "warning",
                where,
                f"the context {driven.context!r} is a {of} [{variable.unit}] and drives a "
                f"{WANTED[unit]} [{unit}]",
                "let another context drive it, or give 'times' that makes the one of the other",
            )
    elif driven.times == 1.0 and size != 1.0:
        yield Finding(
            "warning",
            where,
            f"it is counted in {unit}, and the context {driven.context!r} in {variable.unit}",
            f'give "times": {size:.6g}',
        )
