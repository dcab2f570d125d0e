"""Units of a file, and the factors that make SI of them."""

import re
from dataclasses import dataclass
from functools import cache
from typing import Any

from rga.building.quantities import may_be_unit
from rga.errors import InputError

#: newtons, and metres, in units as programs and people name them
FORCES = {
    "n": 1.0, "kn": 1e3, "mn": 1e6, "kgf": 9.80665, "kp": 9.80665, "tonf": 9806.65, "tf": 9806.65,
    "lb": 4.4482216152605, "lbf": 4.4482216152605, "lbs": 4.4482216152605,
    "kip": 4448.2216152605, "kips": 4448.2216152605,
}  # fmt: skip
LENGTHS = {
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "inch": 0.0254, "inches": 0.0254,
    "ft": 0.3048, "feet": 0.3048,
}  # fmt: skip
#: parts of a system of units that change no number of a static model
OTHERS = {"c", "f", "k", "s", "sec", "degc", "degf"}
SUPERSCRIPTS = str.maketrans({"²": "2", "³": "3", "⁴": "4", "⁶": "6", "·": "*", "°": "deg"})
#: thousandths of a newton or a pascal, which no structure has
THOUSANDTH = re.compile(r"\bm(Pa|N(?=m|\b|[^A-Za-z]))")
#: force and length written as one word, as `kNm`
RUN_TOGETHER = re.compile(r"\b([kM]?N)(mm|m)\b")


@dataclass(frozen=True)
class Units:
    """A system of units: newtons per unit of force, metres per unit of length, the second.

    >>> units = Units.read("kip, in", "--units")
    >>> round(units.stress / 6894757.293168, 9)
    1.0
    """

    force: float
    length: float
    text: str

    @classmethod
    def read(cls, text: str, where: str) -> "Units":
        """A system from its units of force and length, as "kN, m" or "kip, in".

        Raises:
            InputError: a unit is unknown, or force or length is missing or given twice.
        """
        words = [word for word in re.split(r"[\s,;]+", text.strip()) if word]
        forces = [FORCES[word.lower()] for word in words if word.lower() in FORCES]
        lengths = [LENGTHS[word.lower()] for word in words if word.lower() in LENGTHS]
        known = {*FORCES, *LENGTHS, *OTHERS}
        unknown = [word for word in words if word.lower() not in known]
        if unknown or len(forces) != 1 or len(lengths) != 1:
            said = (
                f"{unknown[0]!r} is no unit of force or length"
                if unknown
                else (f"{text!r} is not one unit of force and one of length")
            )
            raise InputError(said, where, 'write them as "kN, m", "N, mm" or "kip, in"')
        return cls(forces[0], lengths[0], text.strip())

    @property
    def stress(self) -> float:
        """Pascals per unit of stress."""
        return self.force / self.length**2

    @property
    def mass(self) -> float:
        """Kilograms per unit of mass, which is the unit of force times s2 per length."""
        return self.force / self.length

    @property
    def density(self) -> float:
        """kg/m3 per unit of mass density."""
        return self.mass / self.length**3

    @property
    def moment(self) -> float:
        """N m per unit of moment."""
        return self.force * self.length

    @property
    def line_load(self) -> float:
        """N/m per unit of load along a member."""
        return self.force / self.length

    def section(self, name: str) -> float:
        """SI per unit of a property of sections: areas [m2], second moments [m4]."""
        return self.length ** (2 if name.startswith("A") else 4)


SI = Units(1.0, 1.0, "N, m")


def to_si(unit: str, si: str, where: str) -> float:
    """SI units per unit.

    Args:
        unit: as a head of a column has it: "kN/m2", "cm4", "MNm/rad".
        si: the unit of the result, which says what sort of quantity it is: "Pa".
        where: it stands, for an error.

    Raises:
        InputError: the unit is unknown, or one of another quantity.

    >>> to_si("N/mm²", "Pa", "E")
    1000000.0
    """
    if THOUSANDTH.search(unit):
        raise InputError(
            f"{unit!r} is thousandths, and most likely millions are meant", where,
            f"write {THOUSANDTH.sub(lambda found: 'M' + found[0][1:], unit.strip())}",
        )  # fmt: skip
    factor = _factor(unit.strip(), si)
    if factor is None:
        raise InputError(
            f"{unit!r} is no unit that becomes {si}", where, f"write it as {si} has it"
        )
    return factor


@cache
def _factor(unit: str, si: str) -> float | None:
    if not may_be_unit(unit):
        return None
    text = re.sub(r"\bkips\b", "kip", _powers(RUN_TOGETHER.sub(r"\1*\2", unit)))
    for candidate in (text, re.sub(r"\blbs?\b", "lbf", text)):
        try:
            found = _registry().parse_units(candidate) if candidate != "1" else None
            one: Any = _registry().Quantity(1.0, found)
            return float(f"{one.to(_powers(si)).magnitude:.15g}")
        except Exception:  # pint says in many ways that it knows no such unit
            continue
    return None


def _powers(unit: str) -> str:
    """A unit with its powers as Python writes them."""
    return re.sub(r"(?<=[A-Za-z])(\d)", r"**\1", unit.translate(SUPERSCRIPTS))


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()
