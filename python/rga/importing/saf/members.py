"""1D members of SAF: straight ones, cut at their internal nodes."""

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.importing.cut import CutMember, add_cut
from rga.importing.draft import ModelDraft
from rga.importing.saf.properties import Properties
from rga.importing.saf.units import SafUnits
from rga.importing.saf.words import word
from rga.importing.sheets import Sheet, SheetRow

FREEDOMS = {"ux": "ux", "uy": "uy", "uz": "uz", "fix": "rx", "fiy": "ry", "fiz": "rz"}
#: share of a member's length by which a node may lie off its line
OFF_LINE = 1e-6


class Members:
    """Adds 1D members to a draft.

    Attributes:
        placed: what became of each member, by its name.
    """

    def __init__(
        self, sheets: dict[str, Sheet], table: SafUnits, draft: ModelDraft, properties: Properties
    ) -> None:
        self.sheets, self.table, self.draft, self.properties = sheets, table, draft, properties
        self.placed: dict[str, CutMember] = {}

    def add(self) -> None:
        """Add all of them, with their hinges."""
        released, springs = self._hinges()
        for row in self.sheets.get("StructuralCurveMember", ()):
            name = row.needed("name")
            self._add(name, row, released.get(name, {}), springs.get(name, {}))

    def _refuse(self, row: SheetRow, what: str, remedy: str = "model it otherwise") -> None:
        self.draft.notes.refuse(row.where, what, remedy, "partial")

    def _add(
        self,
        name: str,
        row: SheetRow,
        released: dict[str, list[str]],
        springs: dict[str, dict[str, float]],
    ) -> None:
        nodes = row.names("nodes") or [row.needed("begin node"), row.needed("end node")]
        curved = [one for one in row.names("segments") if one.lower() != "line"]
        if curved:
            self._refuse(row, f"its segment {curved[0]!r} is not straight", "cut it into lines")
            return
        for node in (*nodes, *row.names("internal nodes")):
            if node not in self.draft.nodes:
                raise InputError(f"node {node!r} is in no sheet", row.where, "add it")
        behaviour = word(row, "behaviour in analysis", self.draft)
        axial = behaviour.startswith("axial")
        if behaviour in ("compression only", "tension only"):
            self.draft.notes.refuse(
                row.where,
                f"it bears {behaviour}, which is not linear",
                "let it bear both",
                "linear",
            )
            axial = True
        self._say_details(row)
        chosen = self.properties.section(row.needed("cross section"), row, axial=axial)
        if chosen is None:
            return
        points = [np.array(self.draft.nodes[node]) for node in nodes]
        straight = self._straight(points)
        order = self._ordered(row, nodes, points) if straight else nodes
        if not straight and row.names("internal nodes"):
            self._refuse(row, "a polyline with internal nodes", "cut it")
            return
        axes = self._axes(row, points)
        if axes is None:
            return
        if axial and (any(released.values()) or any(springs.values())):
            self.draft.notes.say("dropped", row.where, "hinges of a member of axial force only")
        layer = row.text("layer")
        cut = add_cut(
            self.draft, name, order, *chosen, row.where, axes,
            kind="truss" if axial else "frame", releases=released, end_springs=springs,
            groups=[layer] if layer else [],
        )  # fmt: skip
        if cut is not None:
            self.placed[name] = cut

    def _say_details(self, row: SheetRow) -> None:
        if row.text("arbitrary definition"):
            self._refuse(
                row, f"it varies ({row.text('arbitrary definition')}): its section is taken "
                "throughout", "cut it into parts of a section each",
            )  # fmt: skip
        for axis in "yz":
            for end in ("beg", "begin", "end"):
                name = f"analysis {axis} eccentricity of {end} node"
                if row.number_of(name, "m", self.table.small_length, 0.0):
                    self._refuse(row, f"it lies off its nodes ({name})", "move its nodes")

    def _straight(self, points: list[FloatArray]) -> bool:
        along = points[-1] - points[0]
        size = float(np.linalg.norm(along)) or 1.0
        return all(
            np.linalg.norm(np.cross(along / size, point - points[0])) <= OFF_LINE * size
            for point in points[1:-1]
        )

    def _ordered(self, row: SheetRow, nodes: list[str], points: list[FloatArray]) -> list[str]:
        """All nodes on a straight member, from its beginning to its end."""
        along = points[-1] - points[0]
        on_line = {
            node: float((np.array(self.draft.nodes[node]) - points[0]) @ along)
            for node in dict.fromkeys((*nodes, *row.names("internal nodes")))
        }
        return sorted(on_line, key=lambda node: on_line[node])

    def _axes(self, row: SheetRow, points: list[FloatArray]) -> FloatArray | None:
        """Local axes as rows, in the model's axes: SAF, "Coordinate systems"."""
        along = points[1] - points[0]
        size = float(np.linalg.norm(along))
        if size == 0:
            self._refuse(row, "it has no length", "part its nodes")
            return None
        x = along / size
        rule = word(row, "lcs", self.draft)
        raw = [row.number_of(f"coordinate {axis}", "m", self.table.length, 0.0) for axis in "xyz"]
        given = np.array(self.draft.vector(raw))
        if "point" in rule:
            given = given - points[0]
        y = given if rule.startswith("y") else np.cross(given, x)
        y = y - (y @ x) * x
        if np.linalg.norm(y) <= 1e-9 * max(float(np.linalg.norm(given)), 1e-300):
            self.draft.notes.say(
                "assumed", row.where, "the vector of its local axes lies along it: y is horizontal"
            )
            level = np.cross([0.0, 0.0, 1.0], x)
            y = level if np.linalg.norm(level) > 1e-9 else np.array([0.0, 1.0, 0.0])
        y /= np.linalg.norm(y)
        turn = np.radians(row.number_of("lcs rotation", "deg", "deg", 0.0))
        y = np.cos(turn) * y + np.sin(turn) * np.cross(x, y)
        return np.stack([x, y, np.cross(x, y)])

    def _hinges(
        self,
    ) -> tuple[dict[str, dict[str, list[str]]], dict[str, dict[str, dict[str, float]]]]:
        """Released degrees of freedom, and springs, of the ends of members."""
        released: dict[str, dict[str, list[str]]] = {}
        springs: dict[str, dict[str, dict[str, float]]] = {}
        for row in self.sheets.get("RelConnectsStructuralMember", ()):
            position = word(row, "position", self.draft)
            ends = {"begin": "i", "end": "j"}.get(position, "ij")
            for column, dof in FREEDOMS.items():
                state = row.text(column, "Rigid").lower()
                for end in ends:
                    if state == "free":
                        own = released.setdefault(row.needed("member"), {"i": [], "j": []})
                        own[end].append(dof)
                    elif state == "flexible":
                        stiffness = self._stiffness(row, column, dof)
                        of = springs.setdefault(row.needed("member"), {"i": {}, "j": {}})
                        of[end][dof] = stiffness
                if state not in ("free", "rigid", "flexible"):
                    self._refuse(row, f"{column} is {state}: not linear", "make it rigid or free")
        return released, springs

    def _stiffness(self, row: SheetRow, column: str, dof: str) -> float:
        turns = dof[0] == "r"
        name = f"stiffness {column if turns else column[-1]}"
        si, unit = ("N*m/rad", self.table.rotational) if turns else ("N/m", self.table.stiffness)
        return row.number_of(name, si, unit)
