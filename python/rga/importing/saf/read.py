"""Makes a draft of a SAF workbook: nodes, 1D members, supports, hinges."""

from pathlib import Path

from rga.importing.draft import ModelDraft
from rga.importing.options import Chosen
from rga.importing.saf.loads import add_loads
from rga.importing.saf.members import Members
from rga.importing.saf.properties import Properties
from rga.importing.saf.units import SafUnits
from rga.importing.saf.words import word
from rga.importing.sheets import Sheet
from rga.importing.workbook import read_properties

#: degrees of freedom of SAF, and rga's
FREEDOMS = {"ux": "ux", "uy": "uy", "uz": "uz", "fix": "rx", "fiy": "ry", "fiz": "rz"}
#: sheets that are read, that matter and are not read, and why
READ = frozenset((
    "StructuralMaterial", "StructuralCrossSection", "StructuralPointConnection",
    "StructuralCurveMember", "StructuralPointSupport", "RelConnectsStructuralMember",
    "StructuralLoadCase", "StructuralPointAction", "StructuralCurveAction",
    "StructuralPointMoment",
))  # fmt: skip
MATTERS = {
    "StructuralSurfaceMember": "2D members",
    "StructuralSurfaceMemberOpening": "openings of 2D members",
    "StructuralSurfaceMemberRegion": "regions of 2D members",
    "StructuralCurveMemberRib": "ribs of 2D members",
    "StructuralEdgeConnection": "supports along edges",
    "StructuralCurveConnection": "supports along members",
    "StructuralSurfaceConnection": "supports under surfaces",
    "RelConnectsSurfaceEdge": "hinges along edges",
    "RelConnectsRigidLink": "rigid links",
    "RelConnectsRigidMember": "rigid members",
    "RelConnectsRigidCross": "rigid crosses",
    "StructuralPointActionFree": "free point loads",
    "StructuralCurveActionFree": "free line loads",
    "StructuralSurfaceActionFree": "free surface loads",
    "StructuralSurfaceAction": "loads on surfaces",
    "StructuralSurfaceActionDistribution": "load panels",
    "StructuralSurfaceActionDistri": "load panels",
    "StructuralCurveActionThermal": "thermal loads of members",
    "StructuralSurfaceActionThermal": "thermal loads of surfaces",
    "StructuralCurveMoment": "moments along members",
    "StructuralPointSupportDeformation": "moved supports",
    "StructuralPointSupportDef": "moved supports",
}

#: sheets that shape no 1D model
QUIET = frozenset((
    "CompositeShapeDef", "StructuralCurveEdge", "StructuralCurveMemberVarying",
    "StructuralLoadCombination", "StructuralLoadGroup", "StructuralProxyElement",
    "StructuralProxyElementFaces", "StructuralProxyElementVertices", "StructuralStorey",
))  # fmt: skip
#: columns that name parts for other programs
NAMING = frozenset((
    "color", "cross-section type", "description", "description id of the profile", "id",
    "parent id", "type",
))  # fmt: skip


def is_saf(sheets: dict[str, Sheet]) -> bool:
    """Whether a workbook is one of SAF."""
    return "StructuralPointConnection" in sheets or "StructuralCurveMember" in sheets


def read_saf(path: Path, sheets: dict[str, Sheet], chosen: Chosen) -> ModelDraft:
    """A draft of the 1D part of a SAF workbook.

    Args:
        path: the workbook.
        sheets: those of it that are tables.
        chosen: what the user chose.

    Raises:
        InputError: it cannot be read.
    """
    about = read_properties(path, "Model")
    up = "y" if about.get("global coordinate system", "").lower().startswith("y") else "z"
    draft = ModelDraft(about.get("name") or path.stem, chosen.accept, "y" if up == "y" else "z")
    system = about.get("system of units", "")
    if not system:
        draft.notes.say("assumed", "sheet Model", "the system of units is not stated: metric")
    table = SafUnits(imperial=system.lower().startswith("imp"))
    axes = about.get("lcs of cross-section", "ZYX").upper()
    if axes != "ZYX":
        draft.notes.refuse(
            "sheet Model", f"sections in axes {axes}", "export them in axes ZYX", "partial"
        )
    for row in sheets.get("StructuralPointConnection", ()):
        place = [row.number_of(f"coordinate {axis}", "m", table.length) for axis in ("x", "y", "z")]
        draft.add_node(row.needed("name"), place, row.where)
    sheets = _named(sheets)
    properties = Properties(sheets, table, draft, chosen)
    members = Members(sheets, table, draft, properties)
    members.add()
    _add_supports(sheets, table, draft)
    add_loads(sheets, table, draft, members)
    _say_sheets(sheets, draft)
    return draft


def _named(sheets: dict[str, Sheet]) -> dict[str, Sheet]:
    """Sheets by their names as SAF writes them, in whatever letters the file does."""
    names = {name.lower(): name for name in (*READ, *MATTERS, *QUIET)}
    return {names.get(name.strip().lower(), name): sheet for name, sheet in sheets.items()}


def _add_supports(sheets: dict[str, Sheet], table: SafUnits, draft: ModelDraft) -> None:
    for row in sheets.get("StructuralPointSupport", ()):
        node = row.needed("node")
        held: list[str] = []
        for name, dof in FREEDOMS.items():
            state = row.text(name).lower() or "not given"
            if state == "rigid":
                held.append(dof)
            elif state == "flexible":
                axis = f"stiffness {name if dof[0] == 'r' else name[-1]}"
                si, unit = (
                    ("N*m/rad", table.rotational) if dof[0] == "r" else ("N/m", table.stiffness)
                )
                stiffness = row.number_of(axis, si, unit)
                if stiffness > 0:
                    draft.add_spring(node, None, dof, stiffness, row.where)
            elif state != "free":
                draft.notes.refuse(
                    row.where, f"{name} is {state}, none of rigid, free and flexible",
                    "make it one of them", "partial",
                )  # fmt: skip
        if word(row, "coordinate system", draft) == "local":
            draft.notes.refuse(
                row.where, "a support in local axes", "write it in global axes", "partial"
            )
        draft.support(node, held, row.where)


def _say_sheets(sheets: dict[str, Sheet], draft: ModelDraft) -> None:
    found = ", ".join(
        f"{name} {len(sheet.cells)}" for name, sheet in sheets.items() if name in READ
    )
    draft.notes.say("noticed", "workbook", f"rows of the sheets that are read: {found}")
    quiet = []
    for name, sheet in sheets.items():
        if name in READ:
            if columns := [one for one in sheet.unread() if one not in NAMING]:
                said = f"columns that are not read: {', '.join(columns)}"
                draft.notes.say("dropped", f"sheet {name}", said)
            continue
        rows = list(sheet)
        names = ", ".join(row.text("name") for row in rows if row.text("name"))
        shown = f"{names[:200]}{' ...' if len(names) > 200 else ''}"
        unknown = name.startswith(("Structural", "RelConnects")) and name not in QUIET
        if (name in MATTERS or unknown) and rows:
            what = MATTERS.get(name, "rows of a sheet that is not known")
            draft.notes.refuse(
                f"sheet {name}", f"{len(rows)} {what}: {shown}",
                "model them otherwise, or leave them out", "partial",
            )  # fmt: skip
        elif rows:
            quiet.append(f"{name} ({len(rows)})")
    if quiet:
        draft.notes.say("dropped", "sheets", f"what shapes no 1D model: {', '.join(quiet)}")
