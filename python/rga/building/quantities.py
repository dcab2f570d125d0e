"""Quantities as people write them ("3.2 kN", pint's own) in the units of the model file."""

import math
import re
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Any, Protocol

from rga.errors import InputError

if TYPE_CHECKING:
    from pint import UnitRegistry


class WithUnit(Protocol):
    """A quantity of pint."""

    @property
    def magnitude(self) -> Any: ...

    @property
    def units(self) -> Any: ...

    @property
    def to(self) -> Any: ...


#: a number in the unit that the model file wants, a text with a unit, or a quantity of pint
Amount = float | str | WithUnit

#: how long a text with a unit may be: longer is none
LONGEST = 60
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.DOTALL)
_DECIMAL_COMMA = re.compile(r"\s*[+-]?[\d.]+,\d")
#: a digit right behind a letter is a power (mm2), and Nm is no unit of yarn but N m
_POWER = re.compile(r"(?<=[A-Za-z])(?=[2-4]\b)")
#: letters that may have a power of a digit, products and quotients
_UNIT = re.compile(
    r"(?:[^\W\d](?:\d|[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]{1,2}|\s*(?:\*\*|\^)\s*[+-]?\d)?|[°%'\"\s()*/·]|1(?!\d))*"
)
_MOMENT = re.compile(r"\b([kMG]?N)m\b")


def amount(value: Amount, unit: str, where: str) -> float:
    """A quantity as a number in a unit.

    Args:
        value: a number, which is in that unit already; a text of a number and a unit; or a
            quantity of pint, of any registry.
        unit: the unit of the result, as pint writes it; "" for a number without.
        where: what it is, for the error.

    Raises:
        InputError: it is no finite number, has no unit or one unknown, or has another dimension.

    >>> amount("3.2 kN", "N", "a force"), amount("12e-6/K", "1/K", "alpha"), amount(7, "m", "span")
    (3200.0, 1.2e-05, 7.0)
    >>> amount("288.15 K", "degC", "reference")
    15.0
    """
    if isinstance(value, Real) and not isinstance(value, bool):
        number = float(value)
    elif isinstance(value, str):
        number = _of_text(value, unit, where)
    elif not isinstance(value, int | float) and hasattr(value, "magnitude"):
        number = _converted(value, unit, where, str(value))
    else:
        raise _refused(f"{value!r} is no quantity", unit, where)
    if not math.isfinite(number):
        raise _refused(f"{value!r} is no finite number", unit, where)
    return number


def difference(value: Amount, unit: str, where: str) -> float:
    """The same of what lies between two values: a deviation, a rate.

    >>> difference("0.3 K", "degC", "noise"), difference("0.3 degC", "degC", "noise")
    (0.3, 0.3)
    """
    number = amount(value, unit, where)
    if isinstance(value, Real):
        return number
    if isinstance(value, str):
        stated = _NUMBER.fullmatch(value.replace("−", "-"))
        zero: Amount = f"0 {stated[2] if stated else unit}"
    else:
        zero = type(value)(0, value.units)  # type: ignore[call-arg, union-attr]
    return float(f"{number - amount(zero, unit, where):.12g}")


def kelvin(unit: str) -> float:
    """Kelvin in a degree of a unit; 1 where it is no unit of temperature.

    >>> round(kelvin("degF"), 4), kelvin("degC"), kelvin("-")
    (0.5556, 1.0, 1.0)
    """
    try:
        return difference(f"1 {unit}", "K", "temperature")
    except InputError:
        return 1.0


def amounts(values: object, unit: str, where: str, length: int) -> list[float]:
    """Quantities of a sequence, such as the components of a force.

    >>> amounts((0, 0, "-10 kN"), "N", "a force", 3)
    [0.0, 0.0, -10000.0]
    """
    if not isinstance(values, list | tuple) or len(values) != length:
        raise InputError(f"{values!r} is no list of {length} quantities", where, f"give {length}")
    return [amount(value, unit, where) for value in values]


def _of_text(text: str, unit: str, where: str) -> float:
    found = _NUMBER.fullmatch(text.replace("−", "-"))
    if _DECIMAL_COMMA.match(text):
        raise _refused(f"{text[:LONGEST]!r} has a comma; the decimal sign is a point", unit, where)
    if len(text) > LONGEST or found is None:
        shown = text if len(text) <= LONGEST else text[:LONGEST] + "…"
        raise _refused(f"{shown!r} is no number with a unit", unit, where)
    number, stated = float(found[1]), found[2]
    if not stated and unit:
        raise _refused(f"{text!r} has no unit", unit, where)
    try:
        written = _registry().Quantity(number, _unit(stated))
    except Exception:
        # What its parser raises where there is no unit is of many kinds, assertions among them.
        raise _refused(f"{text!r}: the unit {stated!r} is unknown", unit, where) from None
    return _converted(written, unit, where, text)


def _converted(value: WithUnit, unit: str, where: str, shown: str) -> float:
    from pint import DimensionalityError, OffsetUnitCalculusError

    try:
        wanted = _unit(unit)
    except Exception:
        what = f"{shown!r} cannot be converted: {unit!r} is no unit that is known"
        raise InputError(what, where, f"give a number, in {unit}") from None
    try:
        # By the name: the quantity may be of another registry.
        number = value.to(str(wanted)).magnitude
    except (DimensionalityError, OffsetUnitCalculusError):
        raise _refused(f"{shown!r} is of another dimension", unit, where) from None
    try:
        # Fifteen digits: 70 mm are 0.07 m.
        return float(f"{float(number):.15g}")
    except (TypeError, ValueError):
        raise _refused(f"{shown!r} is no single number", unit, where) from None


def _unit(text: str) -> Any:
    if not may_be_unit(text):
        raise ValueError(text)
    return _registry().parse_units(_as_pint_writes(text))


def may_be_unit(text: str) -> bool:
    """Whether a text is written as units are: pint reckons whatever else is in it, without end.

    >>> may_be_unit("kg/m3"), may_be_unit("m**-2"), may_be_unit("9**9**9"), may_be_unit("m/0")
    (True, True, False, False)
    """
    return len(text) <= LONGEST and _UNIT.fullmatch(text) is not None


def _as_pint_writes(unit: str) -> str:
    """A unit as people write it, as pint reads it.

    >>> [_as_pint_writes(unit) for unit in ("/K", "N/mm2", "kNm", "")]
    ['1/K', 'N/mm**2', 'kN m', 'dimensionless']
    """
    if unit in ("", "-"):
        return "dimensionless"
    unit = _MOMENT.sub(r"\1 m", _POWER.sub("**", unit))
    return "1" + unit if unit.startswith("/") else unit


@cache
def _registry() -> "UnitRegistry[Any]":
    import pint

    registry: UnitRegistry[Any] = pint.UnitRegistry()
    registry.define("strain = 1 = ε")
    return registry


def _refused(what: str, unit: str, where: str) -> InputError:
    example = f"write a number, which is in {unit}, or a text such as '1.5 {unit}'"
    return InputError(what, where, example if unit else "give a number without unit")
