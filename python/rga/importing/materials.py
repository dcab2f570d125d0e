"""Materials given by hand, and values of materials that cannot be meant."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rga.errors import InputError
from rga.importing.units import to_si

#: units of the properties of a material; none: a number without one
PROPERTIES = {"E": "Pa", "nu": "", "alpha": "1/K", "density": "kg/m3", "yield_strength": "Pa"}
ALIASES = {"fy": "yield_strength", "rho": "density"}
#: range of E [GPa] and density [kg/m3] of materials by words in their types: handbook values
RANGES = {
    "steel": ((150, 250), (7000, 8500)),
    "stainless": ((150, 250), (7000, 8500)),
    "concrete": ((3, 80), (300, 4000)),
    "aluminium": ((50, 90), (2400, 3000)),
    "timber": ((0.1, 30), (200, 1400)),
    "masonry": ((0.1, 40), (300, 4000)),
}
#: of all others
WIDEST = ((0.01, 500), (1, 25000))
PART = re.compile(r"\s*(\w+)\s*=\s*([-+0-9.eE]+)\s*([^,]*?)\s*$")


@dataclass(frozen=True)
class Given:
    """Properties given by hand for a material of the file; without a name for all of them."""

    name: str | None
    values: dict[str, float]


def read_given(text: str, where: str) -> Given:
    """A material as an option gives it: "E=210GPa, nu=0.3" or "MAT1: E=31GPa, nu=0.2".

    Raises:
        InputError: a property or its unit is unknown, or E is missing.

    >>> read_given("E=210GPa, nu=0.3", "--material").values
    {'E': 210000000000.0, 'nu': 0.3}
    """
    name, colon, rest = text.rpartition(":")
    values: dict[str, float] = {}
    for part in rest.split(","):
        found = PART.match(part)
        key = ALIASES.get(found[1], found[1]) if found else ""
        if found is None or key not in PROPERTIES:
            raise InputError(
                f"{part.strip()!r} is no property of a material", where,
                'write --material "E=210GPa, nu=0.3, density=7850kg/m3, alpha=1.2e-5"',
            )  # fmt: skip
        unit = PROPERTIES[key]
        try:
            number = float(found[2])
        except ValueError:
            raise InputError(f"{found[2]!r} is no number", where, "write a number") from None
        if found[3]:
            number *= to_si(found[3], unit or "dimensionless", where)
        elif key in ("E", "yield_strength"):
            raise InputError(f"{key} has no unit", where, f"write it, as {key}=210GPa")
        values[key] = number
    if "E" not in values:
        raise InputError("the material has no E", where, "give it, as E=210GPa")
    return Given(name.strip() if colon else None, values)


def doubts(values: Mapping[str, float], kind: str) -> Iterator[str]:
    """What cannot be meant about a material, in words.

    Args:
        values: E [Pa], nu, density [kg/m3], alpha [1/K], and G [Pa] where it is stated.
        kind: the type of the material as the file has it.
    """
    words = kind.lower()
    own, range_density = next((r for word, r in RANGES.items() if word in words), WIDEST)
    modulus = values["E"]
    of = f" for {kind.lower()}" if (own, range_density) != WIDEST else ""
    if not own[0] * 1e9 <= modulus <= own[1] * 1e9:
        yield f"E of {modulus / 1e9:g} GPa{of}"
    if not -1 < values.get("nu", 0.3) < 0.5:
        yield f"Poisson's ratio of {values['nu']:g}"
    shear = values.get("G")
    if shear and not modulus / 3.2 <= shear <= modulus and words != "timber":
        yield f"G of {shear / 1e9:g} GPa with E of {modulus / 1e9:g} GPa"
    density = values.get("density", 0.0)
    if density and not range_density[0] <= density <= range_density[1]:
        yield f"density of {density:g} kg/m3{of}"
    if not 0 <= values.get("alpha", 0.0) <= 1e-3:
        yield f"thermal expansion of {values['alpha']:g} 1/K"
