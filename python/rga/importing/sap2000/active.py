"""Degrees of freedom that the analysis of SAP2000 leaves out: CSI Analysis Reference Manual,
"Available and Unavailable Degrees of Freedom"."""

from rga.importing.draft import ModelDraft
from rga.importing.sap2000.tables import Tables

ACTIVE = {"UX": "ux", "UY": "uy", "UZ": "uz", "RX": "rx", "RY": "ry", "RZ": "rz"}
#: degrees of freedom that a model of a plane leaves out
PLANES = {
    "xy": {"uz", "rx", "ry"}, "xz": {"uy", "rx", "rz"}, "yz": {"ux", "ry", "rz"},
}  # fmt: skip


def hold_inactive(tables: Tables, draft: ModelDraft) -> None:
    """Hold what is not active at all nodes, or make it a model of a plane where that is the same.

    Args:
        tables: of the file.
        draft: has the nodes already.

    Raises:
        InputError: a field says neither yes nor no.
    """
    for row in tables.of("ACTIVE DEGREES OF FREEDOM"):
        held = {dof for name, dof in ACTIVE.items() if row.get(name) and not row.yes(name)}
        if not held:
            continue
        names = ", ".join(dof.upper() for dof in ACTIVE.values() if dof in held)
        plane = next((plane for plane, out in PLANES.items() if out == held), None)
        across = "xyz".index(next(iter(set("xyz") - set(plane)))) if plane else 0
        if plane and all(abs(place[across]) <= 1e-9 for place in draft.nodes.values()):
            draft.make_plane(plane)
            said = f"{names} are not active: a model of the plane {plane}"
        else:
            for node in draft.nodes:
                draft.support(node, held, row.where)
            said = f"{names} are not active: every node is held in them"
        draft.notes.say("assumed", row.where, said)
