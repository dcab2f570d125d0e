"""Load patterns of SAP2000: self-weight, forces at joints, loads along frames."""

import numpy as np

from rga.arrays import FloatArray
from rga.importing.cut import CutMember
from rga.importing.draft import ModelDraft
from rga.importing.sap2000.tables import TableRow, Tables
from rga.importing.units import Units

COMPONENTS = ("F1", "F2", "F3", "M1", "M2", "M3")
GLOBAL = {
    "X": (1.0, 0.0, 0.0),
    "Y": (0.0, 1.0, 0.0),
    "Z": (0.0, 0.0, 1.0),
    "GRAVITY": (0.0, 0.0, -1.0),
}
#: degrees of freedom that the ground moves
MOVED = {"U1": "ux", "U2": "uy", "U3": "uz", "R1": "rx", "R2": "ry", "R3": "rz"}


def add_loads(
    tables: Tables,
    units: Units,
    draft: ModelDraft,
    frames: dict[str, CutMember],
    weights: dict[str, float],
) -> None:
    """Add all loads to a draft.

    Args:
        tables: of the file.
        units: of its numbers.
        draft: has the members already.
        frames: what became of each frame.
        weights: self-weight of each frame [N/m].
    """
    for row in tables.of("LOAD PATTERN DEFINITIONS"):
        times = row.number("SelfWtMult", 0.0)
        for name, weight in weights.items() if times else ():
            frame = frames[name]
            down = frame.local([0.0, 0.0, -times * weight])
            if weight:
                frame.load_line(row.text("LoadPat"), (0, frame.length), (down, down), row.where)
    for row in tables.of("JOINT LOADS - FORCE"):
        if row.get("CoordSys", "GLOBAL").upper() != "GLOBAL":
            _refuse(row, draft, f"a load in {row.get('CoordSys')}")
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
        _distributed(row, units, draft, frames)
    for row in tables.of("FRAME LOADS - POINT"):
        _point(row, units, draft, frames)


def _refuse(row: TableRow, draft: ModelDraft, what: str) -> None:
    draft.notes.refuse(row.where, what, "write it as a load along X, Y or Z", "partial")


def _loaded(
    row: TableRow, draft: ModelDraft, frames: dict[str, CutMember]
) -> tuple[CutMember, FloatArray] | None:
    """The frame of a load, and its direction in local axes; None where it cannot be read."""
    frame = frames.get(row.text("Frame"))
    named, system = row.get("Dir", "Gravity").upper(), row.get("CoordSys", "GLOBAL").upper()
    if frame is None:
        _refuse(row, draft, "a load on a frame that is left out")
    elif row.get("Type", "Force").upper() != "FORCE":
        _refuse(row, draft, "a moment along a frame")
    elif system == "LOCAL" and named in ("1", "2", "3"):
        return frame, np.eye(3)[int(named) - 1]
    elif system == "GLOBAL" and named in GLOBAL:
        return frame, frame.local(GLOBAL[named])
    else:
        _refuse(row, draft, f"a load along {named!r} in {system}")
    return None


def _place(row: TableRow, end: str, length: float, units: Units) -> float:
    """A place along a frame [m]: by its share of the length where that is given."""
    if row.get(f"RelDist{end}"):
        return row.number(f"RelDist{end}") * length
    return row.number(f"AbsDist{end}", 0.0) * units.length


def _distributed(
    row: TableRow, units: Units, draft: ModelDraft, frames: dict[str, CutMember]
) -> None:
    found = _loaded(row, draft, frames)
    if found is not None:
        frame, direction = found
        start, end = (_place(row, end, frame.length, units) for end in "AB")
        first, last = (direction * row.number(f"FOverL{end}") * units.line_load for end in "AB")
        case = row.text("LoadPat")
        frame.load_line(case, (start, end), (first, last), row.where)


def _point(row: TableRow, units: Units, draft: ModelDraft, frames: dict[str, CutMember]) -> None:
    found = _loaded(row, draft, frames)
    if found is not None:
        frame, direction = found
        force = direction * row.number("Force") * units.force
        place = _place(row, "", frame.length, units)
        frame.load_point(row.text("LoadPat"), place, force, row.where)
