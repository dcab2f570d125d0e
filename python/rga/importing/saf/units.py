"""Units of SAF where the head of a column states none: the annex "Units table" of its
specification."""

from dataclasses import dataclass


@dataclass(frozen=True)
class SafUnits:
    """The units of metric or imperial workbooks."""

    imperial: bool = False

    @property
    def length(self) -> str:
        return "ft" if self.imperial else "m"

    @property
    def small_length(self) -> str:
        return "in" if self.imperial else "mm"

    @property
    def force(self) -> str:
        return "kip" if self.imperial else "kN"

    @property
    def line_load(self) -> str:
        return "kip/ft" if self.imperial else "kN/m"

    @property
    def moment(self) -> str:
        return "kip*ft" if self.imperial else "kN*m"

    @property
    def modulus(self) -> str:
        return "ksi" if self.imperial else "MPa"

    @property
    def density(self) -> str:
        return "lb/ft3" if self.imperial else "kg/m3"

    @property
    def expansion(self) -> str:
        return "1/delta_degF" if self.imperial else "1/K"

    @property
    def stiffness(self) -> str:
        return "kip/ft" if self.imperial else "MN/m"

    @property
    def rotational(self) -> str:
        return "kip*ft/deg" if self.imperial else "MN*m/rad"

    def section(self, power: int) -> str:
        """Unit of an area (2) or a second moment (4)."""
        return f"{self.length}{power}"
