"""The dimensions that a section is given, as numbers that can be one."""

from rga.building.quantities import Amount, amount
from rga.errors import InputError


def length(value: Amount, where: str) -> float:
    """A dimension of a section [m], larger than nothing."""
    found = amount(value, "m", where)
    if found <= 0:
        raise InputError(f"{found:g} m is no size", where, "give a length above 0")
    return found


def radius(value: Amount, where: str) -> float:
    """A radius [m]; 0 for a sharp corner."""
    found = amount(value, "m", where)
    if found < 0:
        raise InputError(f"{found:g} m is no radius", where, "give 0 or a length")
    return found


def check(fits: bool, what: str, where: str) -> None:
    """InputError where the dimensions of a section do not go together."""
    if not fits:
        raise InputError(what, where, "correct the dimensions")
