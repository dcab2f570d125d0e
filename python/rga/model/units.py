"""Units of sensors, and the factors that turn SI values into them."""

from rga.errors import InputError

#: kind of sensor -> unit -> units per SI unit
UNITS: dict[str, dict[str, float]] = {
    "displacement": {"m": 1.0, "cm": 1e2, "mm": 1e3},
    "rotation": {"rad": 1.0, "mrad": 1e3, "deg": 57.29577951308232},
    "strain": {"m/m": 1.0, "strain": 1.0, "microstrain": 1e6},
    "force": {"N": 1.0, "kN": 1e-3, "MN": 1e-6},
    "reaction": {"N": 1.0, "kN": 1e-3, "MN": 1e-6},
}


def per_si(kind: str, unit: str, where: str) -> float:
    """Units per SI unit of a sensor kind.

    >>> per_si("strain", "microstrain", "sensor 'S1'")
    1000000.0

    Raises:
        InputError: the unit does not belong to the kind.
    """
    known = UNITS[kind]
    if unit not in known:
        raise InputError(
            f"the unit {unit!r} is not one of a {kind} sensor", where, "use " + ", ".join(known)
        )
    return known[unit]
