"""Makes a draft of plain tables; docs/howto/importing.md lists their columns."""

from pathlib import Path

from rga.errors import InputError
from rga.importing.draft import ModelDraft
from rga.importing.numerals import float_of
from rga.importing.options import Chosen
from rga.importing.sheets import Sheet, SheetRow
from rga.model.schema import DOFS

#: columns of each table: their SI units; nothing: text, or a number without one
COLUMNS: dict[str, dict[str, str]] = {
    "nodes": {"name": "", "x": "m", "y": "m", "z": "m"},
    "materials": {
        "name": "", "e": "Pa", "nu": "", "alpha": "1/K", "density": "kg/m3",
        "yield strength": "Pa",
    },
    "sections": {
        "name": "", "a": "m2", "iy": "m4", "iz": "m4", "j": "m4", "asy": "m2", "asz": "m2",
    },
    "members": {
        "name": "", "start": "", "end": "", "section": "", "material": "", "kind": "",
        "group": "", "local y": "", "released at start": "", "released at end": "",
    },
    "supports": {"node": "", **dict.fromkeys(DOFS, "")},
    "springs": {
        "node": "", "to": "", "dof": "", "stiffness": "N/m", "rotational stiffness": "N*m/rad",
    },
    "loads": {
        "case": "", "node": "", "member": "",
        "fx": "N", "fy": "N", "fz": "N", "mx": "N*m", "my": "N*m", "mz": "N*m",
        "wx": "N/m", "wy": "N/m", "wz": "N/m",
        "px": "N", "py": "N", "pz": "N", "at": "m",
    },
}  # fmt: skip
NEEDED = ("nodes", "members", "sections", "materials")
#: names of properties as model files have them
NAMES = {"e": "E", "a": "A", "iy": "Iy", "iz": "Iz", "j": "J", "asy": "Asy", "asz": "Asz",
         "yield strength": "yield_strength"}  # fmt: skip
#: the property that each row must have
FIRST = {"materials": "e", "sections": "a"}
YES = {"1", "yes", "x", "true", "fixed", "rigid"}
NO = {"", "0", "no", "-", "false", "free"}


def is_tables(sheets: dict[str, Sheet]) -> bool:
    """Whether sheets are plain tables of a structure."""
    return {"nodes", "members"} <= {name.lower() for name in sheets}


def read_tables(sheets: dict[str, Sheet], path: Path, chosen: Chosen) -> ModelDraft:
    """A draft of plain tables.

    Args:
        sheets: by name.
        path: where they are from.
        chosen: what the user chose.

    Raises:
        InputError: a table or a column is missing, or a cell cannot be read.
    """
    tables = {name.lower(): sheet for name, sheet in sheets.items()}
    for name in NEEDED:
        if name not in tables:
            raise InputError(f"there is no table {name!r}", str(path), f"add {', '.join(NEEDED)}")
    flat = _plane(tables["nodes"])
    draft = ModelDraft(path.stem, chosen.accept, chosen.up or "z", flat)
    if flat:
        draft.notes.say("assumed", tables["nodes"].name, f"a model of the plane {flat}")
    for row in tables["nodes"]:
        place = [row.number_of(axis, "m") if tables["nodes"].has(axis) else 0.0 for axis in "xyz"]
        draft.add_node(row.needed("name"), place, row.where)
    for kind, table in (("materials", draft.materials), ("sections", draft.sections)):
        for row in tables[kind]:
            name = row.needed("name")
            if name in table:
                raise InputError(f"{name!r} is there already", row.where, "give it another name")
            row.number_of(FIRST[kind], COLUMNS[kind][FIRST[kind]])
            table[name] = {
                NAMES.get(column, column): row.number_of(column, si)
                for column, si in COLUMNS[kind].items()
                if column != "name" and row.raw(column) is not None
            }
    for row in tables["members"]:
        _member(row, draft)
    for row in tables.get("supports", ()):
        draft.support(row.needed("node"), [dof for dof in DOFS if _yes(row, dof)], row.where)
    for row in tables.get("springs", ()):
        dof = row.needed("dof")
        if dof not in DOFS:
            raise InputError(f"{dof!r} is no degree of freedom", row.where, ", ".join(DOFS))
        column = "rotational stiffness" if dof[0] == "r" else "stiffness"
        stiffness = row.number_of(column, COLUMNS["springs"][column])
        draft.add_spring(row.needed("node"), row.text("to") or None, dof, stiffness, row.where)
    for row in tables.get("loads", ()):
        _load(row, draft)
    _say_commas(tables, draft)
    _say_rest(tables, draft)
    return draft


def _plane(nodes: Sheet) -> str | None:
    """The plane of a model of which one coordinate has no column."""
    missing = [axis for axis in "xyz" if not nodes.has(axis)]
    if len(missing) > 1:
        raise InputError(
            f"the columns {', '.join(missing)} are missing", nodes.name, "give two of x, y, z"
        )
    return "xyz".replace(missing[0], "") if missing else None


def _member(row: SheetRow, draft: ModelDraft) -> None:
    kind = row.text("kind", "frame").lower()
    if kind not in ("truss", "frame"):
        raise InputError(f"the kind {kind!r} is not known", row.where, "write truss or frame")
    for table in ("section", "material"):
        if row.needed(table) not in getattr(draft, f"{table}s"):
            name = row.needed(table)
            raise InputError(f"there is no {table} {name!r}", row.where, f"add it to {table}s")
    own = draft.sections[row.needed("section")]
    bending = [name for name in ("Iy", "Iz", "J") if not own.get(name)]
    if kind == "frame" and (len(bending) == 3 if draft.plane else bending):
        draft.notes.refuse(
            row.where, f"its section {row.needed('section')!r} has no {', '.join(bending)}, and a "
            "frame member bends and twists by them", "fill them, or make it a truss", "values",
        )  # fmt: skip
    local_y = row.names("local y")
    if local_y and len(local_y) != 3:
        raise InputError("local y is no vector", row.where, "write it as 0;0;1")
    released = {"i": row.names("released at start"), "j": row.names("released at end")}
    for dof in (*released["i"], *released["j"]):
        if dof not in DOFS:
            raise InputError(f"{dof!r} is no degree of freedom", row.where, ", ".join(DOFS))
    vector = [row.number_in(part, "local y") for part in local_y] or None
    draft.add_member(
        row.needed("name"), (row.needed("start"), row.needed("end")), row.needed("section"),
        row.needed("material"), row.where, kind="truss" if kind == "truss" else "frame",
        local_y=vector, releases=released, groups=row.names("group"),
    )  # fmt: skip


def _yes(row: SheetRow, column: str) -> bool:
    word = row.text(column).lower()
    if word not in YES | NO:
        raise InputError(f"{column} is {word!r}", row.where, "write fixed or free")
    return word in YES


def _used(row: SheetRow, kind: str) -> None:
    """See that a load gives values, and none that a load of its kind does not use."""
    own = {"node": "fm", "member": "wp"}[kind]
    values = [name for name, si in COLUMNS["loads"].items() if si and name != "at"]
    given = [name for name in values if row.raw(name) is not None]
    for name in given:
        if name[0] not in own and row.number_of(name, COLUMNS["loads"][name]):
            raise InputError(
                f"{name!r} is given, which is no load on a {kind}", row.where,
                "put it in a row of its own",
            )  # fmt: skip
    if row.raw("at") is not None and not any(name[0] == "p" for name in given):
        raise InputError("'at' is given without px, py or pz", row.where, "give one of them")
    if not given:
        raise InputError("the load has no value", row.where, f"fill one of {', '.join(values)}")


def _load(row: SheetRow, draft: ModelDraft) -> None:
    case, units = row.text("case", "loads"), COLUMNS["loads"]

    def three(prefix: str) -> list[float]:
        names = [f"{prefix}{axis}" for axis in "xyz"]
        return [row.number_of(name, units[name], default=0.0) for name in names]

    node, member = row.text("node"), row.text("member")
    if bool(node) == bool(member):
        raise InputError("a load is on a node or on a member", row.where, "name one of them")
    _used(row, "node" if node else "member")
    if node:
        draft.add_force(case, node, [*three("f"), *three("m")], row.where)
        return
    uniform, point = three("w"), three("p")
    if any(uniform):
        draft.load_member(case, member, row.where, uniform=uniform)
    if any(point):
        place = row.number_of("at", "m")
        draft.load_member(case, member, row.where, point=point, x=place)


def _say_commas(tables: dict[str, Sheet], draft: ModelDraft) -> None:
    for sheet in tables.values():
        if cell := sheet.decimal_signs.get(","):
            read = f"{float_of(cell.replace(',', '.')):.12g}"
            draft.notes.say(
                "assumed", sheet.name, f"commas in numbers are decimal: {cell} is {read}"
            )


def _say_rest(tables: dict[str, Sheet], draft: ModelDraft) -> None:
    for name, sheet in tables.items():
        if name not in COLUMNS:
            draft.notes.say("dropped", sheet.name, "a table that is not read")
            continue
        for column in sheet.columns:
            if column not in COLUMNS[name]:
                draft.notes.say("dropped", sheet.name, f"the column {column!r}")
