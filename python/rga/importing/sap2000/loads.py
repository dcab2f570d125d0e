"""Load patterns of SAP2000: self-weight, forces at joints, loads along frames."""

import numpy as np

from rga.arrays import FloatArray
from rga.importing.draft import Draft
from rga.importing.sap2000.tables import Row, Tables
from rga.importing.units import Units

COMPONENTS = ("F1", "F2", "F3", "M1", "M2", "M3")
GLOBAL = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0), "GRAVITY": (0, 0, -1.0)}
#: degrees of freedom that the ground moves
MOVED = {"U1": "ux", "U2": "uy", "U3": "uz", "R1": "rx", "R2": "ry", "R3": "rz"}


def add_loads(tables: Tables, units: Units, draft: Draft, weights: dict[str, float]) -> None:
    """Add all loads to a draft.

    Args:
        tables: of the file.
        units: of its numbers.
        draft: has the members already.
        weights: self-weight of each member [N/m].
    """
    for row in tables.of("LOAD PATTERN DEFINITIONS"):
        times = row.number("SelfWtMult", 0.0)
        for member, weight in weights.items() if times else ():
            down = np.array([0.0, 0.0, -times * weight])
            if weight:
                _along(draft, row.text("LoadPat"), member, row.where, uniform=down)
    for row in tables.of("JOINT LOADS - FORCE"):
        if not _global(row, draft):
            continue
        scales = [units.force] * 3 + [units.moment] * 3
        forces = [
            scale * row.number(name, 0.0) for name, scale in zip(COMPONENTS, scales, strict=True)
        ]
        draft.add_force(row.text("LoadPat"), row.text("Joint"), forces, row.where)
    for row in tables.of("JOINT LOADS - GROUND DISPLACEMENT"):
        for name, dof in MOVED.items():
            if moved := row.number(name, 0.0) * (1.0 if dof[0] == "r" else units.length):
                draft.settle(row.text("LoadPat"), row.text("Joint"), dof, moved, row.where)
    for row in tables.of("FRAME LOADS - DISTRIBUTED"):
        _distributed(row, units, draft)
    for row in tables.of("FRAME LOADS - POINT"):
        _point(row, units, draft)


def _global(row: Row, draft: Draft) -> bool:
    system = row.get("CoordSys", "GLOBAL").upper()
    if system != "GLOBAL":
        draft.notes.refuse(row.where, f"a load in {system}", "write it GLOBAL", "partial")
    return system == "GLOBAL"


def _direction(row: Row, draft: Draft, axes: FloatArray) -> FloatArray | None:
    """The direction of a load in local axes, float[3]; None where it cannot be read."""
    named, system = row.get("Dir", "Gravity").upper(), row.get("CoordSys", "GLOBAL").upper()
    if row.get("Type", "Force").upper() != "FORCE":
        draft.notes.refuse(row.where, "a moment along a frame", "load its joints", "partial")
        return None
    if system == "LOCAL" and named in ("1", "2", "3"):
        return np.eye(3)[int(named) - 1]
    if system == "GLOBAL" and named in GLOBAL:
        return np.asarray(axes @ np.array(GLOBAL[named]))
    draft.notes.refuse(
        row.where, f"a load along {named!r} in {system}", "write it along X, Y or Z", "partial"
    )
    return None


def _place(row: Row, name: str, length: float, units: Units) -> float:
    """A place along a frame [m]: by its share of the length where that is given."""
    share = row.get(f"RelDist{name}")
    if share:
        return row.number(f"RelDist{name}") * length
    return row.number(f"AbsDist{name}", 0.0) * units.length


def _axes(draft: Draft, member: str) -> tuple[float, FloatArray]:
    """Length [m] and local axes as rows, float[3, 3]."""
    own = draft.members[member]
    along = np.subtract(draft.nodes[own["nodes"][1]], draft.nodes[own["nodes"][0]])
    length = float(np.linalg.norm(along))
    x, y = along / length, np.array(own["local_y"])
    return length, np.stack([x, y, np.cross(x, y)])


def _along(draft: Draft, case: str, member: str, where: str, uniform: FloatArray) -> None:
    """A uniform load in the model's axes [N/m] along a member."""
    _, axes = _axes(draft, member)
    draft.load_member(case, member, where, uniform=clean(axes @ uniform))


def _distributed(row: Row, units: Units, draft: Draft) -> None:
    member = row.text("Frame")
    if member not in draft.members:
        draft.notes.refuse(row.where, f"a load on frame {member}", "define the frame", "partial")
        return
    length, axes = _axes(draft, member)
    direction = _direction(row, draft, axes)
    if direction is None:
        return
    places = [_place(row, end, length, units) for end in "AB"]
    sizes = [row.number(f"FOverL{end}") * units.line_load for end in "AB"]
    case = row.text("LoadPat")
    whole = abs(places[0]) < 1e-9 * length and abs(places[1] - length) < 1e-9 * length
    if whole and sizes[0] == sizes[1]:
        draft.load_member(case, member, row.where, uniform=clean(direction * sizes[0]))
        return
    for axis, share in zip("xyz", clean(direction), strict=True):
        if share:
            draft.load_member(
                case, member, row.where,
                trapezoid=(places[0], min(places[1], length), *(share * size for size in sizes)),
                axis=axis,
            )  # fmt: skip


def _point(row: Row, units: Units, draft: Draft) -> None:
    member = row.text("Frame")
    if member not in draft.members:
        draft.notes.refuse(row.where, f"a load on frame {member}", "define the frame", "partial")
        return
    length, axes = _axes(draft, member)
    direction = _direction(row, draft, axes)
    if direction is not None:
        share = row.get("RelDist")
        place = row.number("RelDist") * length if share else row.number("AbsDist") * units.length
        point = clean(direction * row.number("Force") * units.force)
        draft.load_member(row.text("LoadPat"), member, row.where, point=point, x=place)


def clean(vector: FloatArray) -> tuple[float, ...]:
    """A vector without what rounding leaves of components that are none.

    >>> clean(np.array([1e-17, -2.0, 0.0]))
    (0.0, -2.0, 0.0)
    """
    largest = float(np.abs(vector).max())
    return tuple(0.0 if abs(v) <= 1e-14 * largest else float(v) for v in vector)
