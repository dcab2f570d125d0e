"""Makes a draft of the tables of SAP2000: joints, frames, sections, restraints and loads."""

from pathlib import Path

import numpy as np

from rga.errors import InputError
from rga.importing.cut import CutMember, add_cut, nodes_between
from rga.importing.draft import ModelDraft
from rga.importing.options import Chosen
from rga.importing.reading import read_text
from rga.importing.sap2000.active import hold_inactive
from rga.importing.sap2000.axes import local_y
from rga.importing.sap2000.loads import add_loads
from rga.importing.sap2000.names import MATTERS, QUIET, READ
from rga.importing.sap2000.tables import TableRow, Tables, read_tables
from rga.importing.shear import poisson
from rga.importing.units import Units

#: fields of a restraint, and degrees of freedom that they hold
RESTRAINTS = {"U1": "ux", "U2": "uy", "U3": "uz", "R1": "rx", "R2": "ry", "R3": "rz"}
#: fields of a release, and degrees of freedom in rga's local axes, whose y is SAP2000's 2
RELEASES = {"P": "ux", "V2": "uy", "V3": "uz", "T": "rx", "M2": "ry", "M3": "rz"}
#: stiffness of a spring at a joint
SPRINGS = {"U1": "ux", "U2": "uy", "U3": "uz", "R1": "rx", "R2": "ry", "R3": "rz"}
#: words in a name that say a shape, and the shape as SAP2000 calls it
SHAPES = {
    "chs": ("pipe",), "shs": ("box/tube",), "rhs": ("box/tube",), "pipe": ("pipe",),
    "ipe": ("i/wide flange",), "hea": ("i/wide flange",), "heb": ("i/wide flange",),
    "upn": ("channel",), "upe": ("channel",),
}  # fmt: skip


def read_sap2000(path: Path, chosen: Chosen) -> ModelDraft:
    """A draft of a model of SAP2000.

    Args:
        path: its text tables.
        chosen: units instead of those that the file states, and what the user accepts.

    Raises:
        InputError: it cannot be read.
    """
    tables = read_tables(read_text(path), path.name)
    draft = ModelDraft(path.stem, chosen.accept)
    system = chosen.system or _units(tables, path.name)
    reader = _Reader(tables, system, draft)
    reader.read()
    hold_inactive(tables, draft)
    add_loads(tables, system, draft, reader.frames, reader.weights)
    _say_tables(tables, draft)
    return draft


def _units(tables: Tables, file: str) -> Units:
    for row in tables.of("PROGRAM CONTROL"):
        if row.get("CurrUnits"):
            return Units.read(row.get("CurrUnits"), row.where)
    raise InputError(
        "the file does not state its units (CurrUnits of PROGRAM CONTROL)",
        file,
        'give them, as --units "kN, m"',
    )


class _Reader:
    """Joints, frames, restraints and springs.

    Attributes:
        weights: self-weight of each frame [N/m].
        frames: what became of each.
        meshed: names of frames that joints on them cut.
    """

    def __init__(self, tables: Tables, units: Units, draft: ModelDraft) -> None:
        self.tables, self.units, self.draft = tables, units, draft
        self.weights: dict[str, float] = {}
        self.frames: dict[str, CutMember] = {}
        self.meshed = {
            row.text("Frame")
            for row in tables.of("FRAME AUTO MESH ASSIGNMENTS")
            if row.yes("AutoMesh") and row.yes("AtJoints")
        }
        self.materials = tables.by(
            "Material", "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"
        )
        self.yields = {
            row.text("Material"): row.number("Fy", 0.0)
            for row in tables.of("MATERIAL PROPERTIES 03A - STEEL DATA")
        }
        self.sections = tables.by("SectionName", "FRAME SECTION PROPERTIES 01 - GENERAL")

    def read(self) -> None:
        """Read all of them."""
        for row in self.tables.of("JOINT COORDINATES"):
            if row.get("CoordType", "Cartesian").lower() != "cartesian":
                raise InputError("coordinates are not Cartesian", row.where, "export them so")
            system = row.get("CoordSys", "GLOBAL")
            if system.upper() != "GLOBAL":
                raise InputError(f"coordinates are in {system!r}", row.where, "export them GLOBAL")
            place = [self.units.length * row.number(axis) for axis in ("XorR", "Y", "Z")]
            self.draft.add_node(row.text("Joint"), place, row.where)
        assigned = self.tables.by("Frame", "FRAME SECTION ASSIGNMENTS")
        axes = self.tables.by("Frame", "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL")
        angles = {name: row.number("Angle", 0.0) for name, row in axes.items()}
        released = self._releases()
        for row in self.tables.of("CONNECTIVITY - FRAME"):
            self._add_frame(row, assigned, angles, released)
        for row in self.tables.of("JOINT RESTRAINT ASSIGNMENTS"):
            held = [dof for name, dof in RESTRAINTS.items() if row.yes(name)]
            self.draft.support(row.text("Joint"), held, row.where)
        for row in self.tables.of("JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED"):
            for name, dof in SPRINGS.items():
                stiffness = row.number(name, 0.0)
                scale = self.units.moment if dof[0] == "r" else self.units.line_load
                if stiffness:
                    joint = row.text("Joint")
                    self.draft.add_spring(joint, None, dof, stiffness * scale, row.where)

    def _releases(self) -> dict[str, dict[str, list[str]]]:
        found: dict[str, dict[str, list[str]]] = {}
        for row in self.tables.of("FRAME RELEASE ASSIGNMENTS 1 - GENERAL"):
            if row.yes("PartialFix"):
                self.draft.notes.refuse(
                    row.where, "a partial release", "make it whole or none", "partial"
                )
            ends = {
                end: [dof for name, dof in RELEASES.items() if row.yes(f"{name}{end.upper()}")]
                for end in "ij"
            }
            found[row.text("Frame")] = ends
        return found

    def _add_frame(
        self,
        row: TableRow,
        assigned: dict[str, TableRow],
        angles: dict[str, float],
        released: dict[str, dict[str, list[str]]],
    ) -> None:
        name, ends = row.text("Frame"), (row.text("JointI"), row.text("JointJ"))
        if row.yes("IsCurved"):
            self.draft.notes.refuse(
                row.where, "a curved frame", "cut it into straight ones", "partial"
            )
            return
        given = assigned.get(name)
        section = self.sections.get(given.get("AnalSect")) if given else None
        if given is None or section is None:
            what = f"section {given.get('AnalSect')!r}" if given else "a section"
            self.draft.notes.refuse(
                row.where, f"frame {name} has {what} that is not in the tables",
                "export FRAME SECTION PROPERTIES 01 - GENERAL", "partial",
            )  # fmt: skip
            return
        own = given.get("MatProp", "Default")
        material = section.get("Material") if own.lower() in ("default", "") else own
        properties = self._material(material, given)
        if properties is None:
            return
        for end in ends:
            if end not in self.draft.nodes:
                raise InputError(f"joint {end!r} is not there", row.where, "define it")
        if not self.draft.has_length(*ends):
            self.draft.notes.refuse(row.where, "a frame of no length", "take it out", "partial")
            return
        along = np.subtract(self.draft.nodes[ends[1]], self.draft.nodes[ends[0]])
        y = local_y(along, angles.get(name, 0.0))
        x = along / np.linalg.norm(along)
        self._bends(section, released.get(name, {"i": [], "j": []}))
        nodes = nodes_between(self.draft, *ends) if name in self.meshed else ends
        frame = add_cut(
            self.draft, name, nodes, self._section(section, material),
            self.draft.material(material, **properties), row.where,
            np.stack([x, y, np.cross(x, y)]), releases=released.get(name),
        )  # fmt: skip
        if frame is not None:
            self.frames[name] = frame
            weight = self.materials[material].number("UnitWeight", 0.0)
            scale = self.units.force / self.units.length
            self.weights[name] = section.number("Area") * weight * scale

    def _bends(self, section: TableRow, released: dict[str, list[str]]) -> None:
        """See that a section has the second moments by which a frame bends."""
        for field, dof in (("I33", "rz"), ("I22", "ry")):
            hinged = all(dof in ends for ends in released.values())
            if not hinged and section.number(field, 0.0) <= 0:
                self.draft.notes.refuse(
                    section.where, f"section {section.text('SectionName')!r} has no {field}, by "
                    "which its frames bend", "give it", "values",
                )  # fmt: skip

    def _material(self, name: str, given: TableRow) -> dict[str, float] | None:
        row = self.materials.get(name)
        if row is None:
            self.draft.notes.refuse(
                given.where, f"material {name!r} is not in the tables",
                "export MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES", "partial",
            )  # fmt: skip
            return None
        modulus = row.number("E1")
        nu, _ = poisson(modulus, row.number("G12", 0.0))
        found = {
            "E": modulus * self.units.stress,
            "nu": nu,
            "alpha": row.number("A1", 0.0),
            "density": row.number("UnitMass", 0.0) * self.units.density,
        }
        if self.yields.get(name):
            found["yield_strength"] = self.yields[name] * self.units.stress
        return found

    def _section(self, row: TableRow, material: str) -> str:
        name, shape = row.text("SectionName"), row.get("Shape")
        for word, shapes in SHAPES.items():
            if word in name.lower().replace("(", " ").split() and shape.lower() not in shapes:
                self.draft.notes.say(
                    "noticed", row.where, f"the section {name!r} is a {shape}, whatever its name"
                )
        if shape.lower().startswith(("nonprismatic", "general nonprismatic")):
            self.draft.notes.refuse(
                row.where, f"section {name!r} varies along the frame", "cut it", "partial"
            )
        modulus = self.materials[material].number("E1")
        _, ratio = poisson(modulus, self.materials[material].number("G12", 0.0))
        numbers = {
            "A": row.number("Area"),
            # Local 2 is y and 3 is z: I33 bends in the plane 1-2.
            "Iz": row.number("I33", 0.0),
            "Iy": row.number("I22", 0.0),
            "J": row.number("TorsConst", 0.0) * ratio,
            "Asy": row.number("AS2", 0.0) * ratio,
            "Asz": row.number("AS3", 0.0) * ratio,
        }
        modified = [
            f"{key}={row.get(key)}"
            for key in ("AMod", "A2Mod", "A3Mod", "JMod", "I2Mod", "I3Mod")
            if row.number(key, 1.0) != 1.0
        ]
        if modified:
            self.draft.notes.refuse(
                row.where, f"section {name!r} is modified: {', '.join(modified)}",
                "write the modified properties", "values",
            )  # fmt: skip
        values = {
            key: value * self.units.section(key) for key, value in numbers.items() if value > 0
        }
        if not values.get("A"):
            raise InputError(f"section {name!r} has no area", row.where, "give it one")
        return self.draft.section(name, **values)


def _say_tables(tables: Tables, draft: ModelDraft) -> None:
    for words, where in tables.others:
        draft.notes.say("dropped", where, f"a line outside of all tables: {words!r}")
    quiet = []
    for name, rows in tables.rows.items():
        if name in READ:
            continue
        matters = next((m for m in MATTERS if name.startswith(m)), None)
        rows = [row for row in rows if not _idle(name, row)]
        if matters is not None and rows:
            draft.notes.refuse(
                joined_rows(rows), f"table {name!r}: {MATTERS[matters]}",
                "take it out, or write it as the tables that are read", "partial",
            )  # fmt: skip
        elif not name.startswith(QUIET) and rows:
            draft.notes.say("dropped", f"line {tables.lines[name]}", f"table {name!r}")
        else:
            quiet.append(name)
    if quiet:
        draft.notes.say(
            "dropped",
            "tables",
            f"{len(quiet)} tables that say nothing of the structure or are empty: "
            + ", ".join(sorted(quiet)),
        )


def _idle(name: str, row: TableRow) -> bool:
    """Whether a row of a table that matters changes nothing."""
    if name.startswith("FRAME PROPERTY MODIFIERS"):
        return all(row.number(field, 1.0) == 1 for field in row.values if field.endswith("mod"))
    if name.startswith("FRAME OFFSET"):
        return not (row.number("LengthI", 0.0) or row.number("LengthJ", 0.0))
    if name.startswith("FRAME INSERTION POINT"):
        kept = any(
            row.get(field).lower() == "no"
            for field in ("StiffTransform", "StiffTrans", "Transform")
        )
        moved = any(row.number(f"Offset{axis}{end}", 0.0) for axis in "XYZ123" for end in "IJ")
        return kept or (row.get("CardinalPt", "10").split(" ")[0] in ("10", "11") and not moved)
    return False


def joined_rows(rows: list[TableRow]) -> str:
    """The lines of rows in words."""
    first, last = rows[0].line, rows[-1].line
    return f"line {first}" if first == last else f"lines {first}-{last}"
