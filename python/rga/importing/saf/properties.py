"""Materials and sections of SAF, as they are or by their shapes."""

from collections.abc import Mapping

from rga.building import rolled_section
from rga.errors import InputError
from rga.importing.draft import ModelDraft
from rga.importing.materials import doubts
from rga.importing.options import Chosen
from rga.importing.saf.units import SafUnits
from rga.importing.section_shapes import area_of, by_shape
from rga.importing.shear import poisson
from rga.importing.sheets import Sheet, SheetRow, read_number


def _rolled(profile: str, axial: bool) -> dict[str, float] | None:
    """Properties of a rolled section by the tables of the standards; None where these have none."""
    try:
        found = rolled_section(profile)
    except InputError:
        return None
    if profile.strip().upper().startswith(("L", "ISA")) and not axial:
        # Tables of angles are about principal axes, which do not stand as the member does.
        return None
    return {"A": found.A, "Iy": found.Iy, "Iz": found.Iz, "J": found.J}


class Properties:
    """Materials and sections by name, added to a draft when a member uses them."""

    def __init__(
        self, sheets: dict[str, Sheet], table: SafUnits, draft: ModelDraft, chosen: Chosen
    ) -> None:
        self.table, self.draft = table, draft
        self.given, self.given_sections = chosen.materials, chosen.sections
        self._materials = {row.needed("name"): row for row in sheets.get("StructuralMaterial", ())}
        self._sections = {
            row.needed("name"): row for row in sheets.get("StructuralCrossSection", ())
        }
        self._known: dict[str, Mapping[str, float]] = {}
        self._doubted()

    def _doubted(self) -> None:
        """Say what cannot be meant about materials, those no member uses too."""
        for name, row in self._materials.items():
            if name in self.given or None in self.given:
                self._known[name] = self.given.get(name) or self.given[None]
                self.draft.notes.say(
                    "assumed", row.where, "its properties are those given, not the file's"
                )
                continue
            values = self._values(row)
            self._known[name] = values
            for doubt in doubts(values, row.text("type")):
                self.draft.notes.refuse(
                    row.where, f"{doubt} cannot be meant",
                    'give the material, as --material "E=210GPa, nu=0.3"', "values",
                )  # fmt: skip

    def _values(self, row: SheetRow) -> dict[str, float]:
        table = self.table
        values = {
            "E": row.number_of("e modulus", "Pa", table.modulus),
            "G": row.number_of("g modulus", "Pa", table.modulus, 0.0),
            "density": row.number_of("unit mass", "kg/m3", table.density, 0.0),
            "alpha": row.number_of("thermal expansion", "1/K", table.expansion, 0.0),
        }
        values["nu"] = row.number_of("poisson coefficient", default=0.3)
        return values

    def material(self, name: str, row: SheetRow) -> str | None:
        """The name of a material in the draft; None where the file has none of this name."""
        values = self._known.get(name)
        if values is None:
            self.draft.notes.refuse(
                row.where, f"material {name!r} is in no sheet", "add it", "partial"
            )
            return None
        nu, _ = poisson(values["E"], values.get("G"))
        if not values.get("G"):
            nu = values.get("nu", 0.3)
        plain = {key: value for key, value in values.items() if key not in ("G", "nu")}
        sound = -1 < nu < 0.5
        return self.draft.material(name, **plain, nu=nu if sound else 0.3)

    def section(self, name: str, row: SheetRow, *, axial: bool) -> tuple[str, str] | None:
        """Names of a section and its material in the draft; None where they are not known.

        Args:
            name: of the section.
            row: of the member.
            axial: whether the area is all that is needed.
        """
        own = self._sections.get(name)
        if own is None:
            self.draft.notes.refuse(
                row.where, f"section {name!r} is in no sheet", "add it", "partial"
            )
            return None
        material = self.material(own.names("material")[0] if own.names("material") else "", own)
        values = self._by_hand(name, own) or self._stated(own, axial)
        if values is None:
            values = self.given_sections.get(None) or self._shaped(own, axial)
        if material is None or values is None:
            return None
        return self.draft.section(name, **values), material

    def _by_hand(self, name: str, row: SheetRow) -> Mapping[str, float] | None:
        """Properties given by hand for a section or for its profile."""
        return self.given_sections.get(name) or self.given_sections.get(row.text("profile") or name)

    def _stated(self, row: SheetRow, axial: bool) -> dict[str, float] | None:
        """Properties that the file states; None where one that is needed is missing."""
        columns = {"A": ("a", 2), "Iy": ("iy", 4), "Iz": ("iz", 4), "J": ("it", 4)}
        found = {
            key: row.number_of(column, f"m{power}", self.table.section(power), 0.0)
            for key, (column, power) in columns.items()
        }
        needed = ("A",) if axial else ("A", "Iy", "Iz", "J")
        if any(found[key] <= 0 for key in needed):
            return None
        return {key: value for key, value in found.items() if value > 0}

    def _shaped(self, row: SheetRow, axial: bool) -> dict[str, float] | None:
        shape = row.text("shape")
        scale = row.scale("parameters", "m", self.table.small_length)
        dimensions = [
            read_number(part, "parameters", row.where) * scale for part in row.names("parameters")
        ]
        kind = row.text("cross-section type").lower()
        found, rounded = by_shape(shape, dimensions) if kind == "parametric" else (None, False)
        if found is None and axial and kind == "parametric":
            found, rounded = area_of(shape, dimensions), True
        if found is None and (found := _rolled(row.text("profile"), axial)) is not None:
            self.draft.notes.say(
                "assumed", row.where, f"A, Iy, Iz, It of {row.text('profile')} are those of the "
                "standard",
            )  # fmt: skip
        if found is None:
            of = " ".join(filter(None, (shape, row.text("profile"), row.text("parameters"))))
            self.draft.notes.refuse(
                row.where, f"no A, Iy, Iz and It, and none follow from {of!r}",
                f'fill these columns, or give it, as --section "{row.text("name")}: A=..."',
                "partial",
            )  # fmt: skip
        elif rounded:
            self.draft.notes.say(
                "assumed", row.where, f"A, Iy, Iz, It of {shape} {row.text('parameters')} "
                "without roundings",
            )  # fmt: skip
        return found
