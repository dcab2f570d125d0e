"""Materials and sections given by hand, for files that have none or wrong ones."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from rga.errors import InputError
from rga.importing.numerals import float_of
from rga.importing.units import to_si

#: units of the properties; none: a number without one
MATERIAL = {"E": "Pa", "nu": "", "alpha": "1/K", "density": "kg/m3", "yield_strength": "Pa"}
SECTION = {"A": "m2", "Iy": "m4", "Iz": "m4", "J": "m4", "Asy": "m2", "Asz": "m2"}
ALIASES = {"fy": "yield_strength", "rho": "density", "It": "J"}
#: properties whose numbers are the same in all units that anyone uses
UNITLESS = ("nu", "alpha")
PART = re.compile(r"\s*(\w+)\s*=\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^,=]*?)\s*$")


@dataclass(frozen=True)
class Given:
    """Properties given by hand [SI]; a name is that of the file's part which they replace."""

    name: str | None
    values: dict[str, float]


def read_given(text: str, properties: Mapping[str, str], option: str, example: str) -> Given:
    """Properties as an option has them, with or without the name of what they are of.

    Args:
        text: "E=210GPa, nu=0.3" or "MAT1: E=31GPa".
        properties: names that may be given, and their SI units.
        option: for an error.
        example: of what would be right.

    Raises:
        InputError: a property or its unit is unknown, or the first of all is missing.

    >>> read_given("E=210GPa, nu=0.3", MATERIAL, "--material", "").values
    {'E': 210000000000.0, 'nu': 0.3}
    >>> read_given("IPE180: A=23.9 cm2", SECTION, "--section", "").name
    'IPE180'
    """
    name, colon, rest = text.rpartition(":")
    values: dict[str, float] = {}
    for part in rest.split(","):
        found = PART.match(part)
        key = ALIASES.get(found[1], found[1]) if found else ""
        if found is None or key not in properties:
            raise InputError(f"{part.strip()!r} is no property", option, f"write {example}")
        try:
            number = float_of(found[2])
        except ValueError:
            raise InputError(f"{found[2]!r} is no number", option, f"write {example}") from None
        if found[3]:
            number *= to_si(found[3], properties[key] or "dimensionless", option)
        elif key not in UNITLESS:
            raise InputError(f"{key} has no unit", option, f"write {example}")
        values[key] = number
    first = next(iter(properties))
    if not 0 < values.get(first, 0.0) < 1e300:
        raise InputError(f"{first} is not given, or no number above 0", option, f"write {example}")
    return Given(name.strip() if colon else None, values)


def read_materials(texts: Iterable[str]) -> dict[str | None, dict[str, float]]:
    """Materials given by hand, by the name of the file's; None: of all others."""
    example = '--material "E=210GPa, nu=0.3, density=7850kg/m3, alpha=1.2e-5"'
    found = (read_given(text, MATERIAL, "--material", example) for text in texts)
    return {one.name: one.values for one in found}


def read_sections(texts: Iterable[str]) -> dict[str | None, dict[str, float]]:
    """Sections given by hand, by the name of the file's; None: of all others."""
    example = '--section "A=23.9cm2, Iy=1317cm4, Iz=101cm4, J=4.8cm4"'
    found = (read_given(text, SECTION, "--section", example) for text in texts)
    return {one.name: one.values for one in found}
