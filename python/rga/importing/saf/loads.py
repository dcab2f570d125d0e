"""Loads of SAF on nodes and 1D members."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import FloatArray
from rga.importing.cut import CutMember, clean
from rga.importing.draft import NEAR, ModelDraft
from rga.importing.saf.members import Members
from rga.importing.saf.units import SafUnits
from rga.importing.saf.words import word
from rga.importing.sheets import Sheet, SheetRow, read_number

GRAVITY = 9.81
DIRECTIONS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def add_loads(
    sheets: dict[str, Sheet], table: SafUnits, draft: ModelDraft, members: Members
) -> None:
    """Add loads on nodes and members to a draft."""
    loads = _Loads(table, draft, members)
    for row in sheets.get("StructuralLoadCase", ()):
        if row.text("load type").lower() == "self weight":
            loads.self_weight(row)
    for row in sheets.get("StructuralPointAction", ()):
        loads.force(row)
    for row in sheets.get("StructuralPointMoment", ()):
        loads.moment(row)
    for row in sheets.get("StructuralCurveAction", ()):
        loads.along(row)


class _Loads:
    def __init__(self, table: SafUnits, draft: ModelDraft, members: Members) -> None:
        self.table, self.draft, self.members = table, draft, members

    def _refuse(self, row: SheetRow, what: str) -> None:
        self.draft.notes.refuse(
            row.where, what, "write it as a load of a member or node", "partial"
        )

    def self_weight(self, row: SheetRow) -> None:
        """The weight of all members, downward in the model's axes."""
        self.draft.notes.say(
            "assumed", row.where, f"the weight of members by their density, g = {GRAVITY} m/s2"
        )
        for placed in self.members.placed.values():
            for part in placed.parts:
                own = self.draft.members[part.name]
                density = self.draft.materials[own["material"]].get("density", 0.0)
                weight = density * self.draft.sections[own["section"]]["A"] * GRAVITY
                uniform = clean(placed.axes @ np.array([0.0, 0.0, -weight]))
                if weight:
                    self.draft.load_member(
                        row.needed("name"), part.name, row.where, uniform=uniform
                    )

    def _direction(self, row: SheetRow, placed: CutMember | None) -> FloatArray | None:
        """Direction of a load: in local axes of a member, or in the file's at a node."""
        name = row.text("direction").lower().removeprefix("m")
        local = word(row, "coordinate system", self.draft) == "local"
        if name not in DIRECTIONS:
            self._refuse(row, f"its direction {name!r} is not read")
            return None
        vector = np.array(DIRECTIONS[name])
        if placed is None:
            if local:
                self._refuse(row, "a load of a node in local axes")
                return None
            return vector
        return vector if local else placed.local(vector.tolist())

    def _vectors(self, row: SheetRow, columns: tuple[str, str]) -> list[FloatArray] | None:
        """Components of a load by vector, of its beginning and its end."""
        found = []
        for column in columns:
            parts = [part for part in row.text(column).strip("()").split(";") if part.strip()]
            if len(parts) == 3:
                values = [read_number(part, column, row.where) for part in parts]
                found.append(np.array(values))
        return found or None

    def force(self, row: SheetRow) -> None:
        """A `StructuralPointAction`."""
        scale = row.scale("value", "N", self.table.force)
        by_vector = row.text("direction").lower() == "vector"
        where = row.text("force action").lower()
        placed = None
        if where.endswith("beam"):
            placed = self._placed(row, "reference member")
            if placed is None:
                return
        elif not where.endswith("node"):
            self._refuse(row, f"a force {where}")
            return
        if by_vector:
            vectors = self._vectors(row, ("vector (x;y;z)", "vector"))
            if not vectors:
                self._refuse(row, "its vector is not given")
                return
            local = word(row, "coordinate system", self.draft) == "local"
            size: FloatArray = vectors[0] * scale
            if placed is not None and not local:
                size = placed.local(size.tolist())
        else:
            direction = self._direction(row, placed)
            if direction is None:
                return
            size = direction * row.number_of("value", "N", self.table.force)
        case = row.needed("load case")
        if placed is None:
            self.draft.add_force(case, row.needed("reference node"), [*size, 0, 0, 0], row.where)
            return
        for place in self._places(row, placed):
            placed.load_point(case, place, np.asarray(size), row.where)

    def moment(self, row: SheetRow) -> None:
        """A `StructuralPointMoment`."""
        if not row.text("force action").lower().endswith("node"):
            self._refuse(row, "a moment on a member")
            return
        direction = self._direction(row, None)
        if direction is not None:
            size = direction * row.number_of("value", "N*m", self.table.moment)
            node, case = row.needed("reference node"), row.needed("load case")
            self.draft.add_force(case, node, [0, 0, 0, *size], row.where)

    def along(self, row: SheetRow) -> None:
        """A `StructuralCurveAction`."""
        where = row.text("force action").lower()
        if not where.endswith("beam"):
            self._refuse(row, f"a line load {where}")
            return
        placed = self._placed(row, "member")
        if placed is None:
            return
        for axis in ("ey", "ez"):
            if row.number_of(f"eccentricity {axis}", "m", self.table.small_length, 0.0):
                self._refuse(row, "a line load off its member")
        uniform = word(row, "distribution", self.draft) == "uniform"
        sizes: list[FloatArray]
        if row.text("direction").lower() == "vector":
            scale = row.scale("vector 1(x;y;z)", "N/m", self.table.line_load)
            vectors = self._vectors(row, ("vector 1(x;y;z)", "vector 2(x;y;z)"))
            if not vectors or (not uniform and len(vectors) < 2):
                self._refuse(row, "its vectors are not given")
                return
            local = word(row, "coordinate system", self.draft) == "local"
            sizes = [
                (v if local else placed.local(v.tolist())) * scale
                for v in (vectors[0], vectors[0 if uniform else 1])
            ]
        else:
            direction = self._direction(row, placed)
            if direction is None:
                return
            first = row.number_of("value 1", "N/m", self.table.line_load)
            second = first if uniform else row.number_of("value 2", "N/m", self.table.line_load)
            sizes = [direction * first, direction * second]
        if word(row, "location", self.draft) == "projection":
            size = float(np.linalg.norm(sizes[0])) or float(np.linalg.norm(sizes[1])) or 1.0
            along = max((sizes[0], sizes[1]), key=lambda one: float(np.linalg.norm(one)))
            share = float(np.sqrt(max(0.0, 1 - (along[0] / max(np.linalg.norm(along), size)) ** 2)))
            sizes = [share * one for one in sizes]
        self._spread(row, placed, sizes)

    def _spread(self, row: SheetRow, placed: CutMember, sizes: list[FloatArray]) -> None:
        """Put a linear load on the parts of a member that it covers."""
        start = self._place(row, "start point", placed, 0.0)
        end = self._place(row, "end point", placed, placed.length)
        if word(row, "origin", self.draft) == "from end":
            start, end = placed.length - end, placed.length - start
            sizes = sizes[::-1]
        if word(row, "extent", self.draft) == "full":
            near = NEAR * placed.length
            whole = abs(start) <= near and abs(end - placed.length) <= near
            if not whole and start != end:
                self._refuse(row, "its extent is Full, and its points are not those of the whole")
                return
            start, end = 0.0, placed.length
        ends = (sizes[0], sizes[1])
        placed.load_line(row.needed("load case"), (start, end), ends, row.where)

    def _placed(self, row: SheetRow, column: str) -> CutMember | None:
        name = row.needed(column)
        if name not in self.members.placed:
            self._refuse(row, "a load of a member that is left out")
            return None
        return self.members.placed[name]

    def _place(self, row: SheetRow, column: str, placed: CutMember, default: float) -> float:
        """A place along a member [m]: a share of its length, or a length."""
        if row.raw(column) is None:
            return default
        if word(row, "coordinate definition", self.draft) == "relative":
            share = row.raw(column)
            return read_number(share, column, row.where) * placed.length
        return row.number_of(column, "m", self.table.length)

    def _places(self, row: SheetRow, placed: CutMember) -> Iterator[float]:
        """Places of a point load, and of those that repeat it."""
        first = self._place(row, "position x", placed, 0.0)
        step = self._place(row, "delta x", placed, 0.0)
        count = int(row.number_of("repeat (n)", default=1.0)) or 1
        for number in range(max(1, min(count, 1000))):
            place = first + number * step
            yield placed.length - place if word(row, "origin", self.draft) == "from end" else place
