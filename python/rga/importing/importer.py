"""`import_model`: which reader a source needs."""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any, Literal

from rga.errors import InputError
from rga.importing.draft import ModelDraft
from rga.importing.given import read_materials, read_sections
from rga.importing.imported import ImportedModel
from rga.importing.notes import Acceptance
from rga.importing.options import Chosen

KINDS = "give .tcl or .py (OpenSees, PyNite), .xlsx (SAF, tables), .csv tables, .s2k or .dxf"


def import_model(
    source: Any,
    *,
    units: str | None = None,
    up: Literal["y", "z"] | None = None,
    plane: Literal["xy", "xz", "yz"] | None = None,
    accept: Collection[Acceptance] = (),
    without: Collection[str] = (),
    materials: Collection[str] = (),
    sections: Collection[str] = (),
    kind: Literal["truss", "frame"] | None = None,
    tolerance: float | None = None,
    combination: str | None = None,
) -> ImportedModel:
    """Read a model of another program; no script is run.

    Args:
        source: the file, a folder or several files of tables (.csv), or a PyNite `FEModel3D`.
        units: of a file that does not state its own, as "kip, in"; of a drawing, "mm".
        up: the axis of a model in space that points up.
        plane: makes it a model of this plane of rga's axes, in which all nodes must lie.
        accept: "linear" (second order read as first), "partial" (what cannot be read is left out),
            "values" (properties that look wrong are taken as they are).
        without: files that a script reads and that are not needed.
        materials: instead of the file's, as "E=210GPa, nu=0.3" or "MAT1: E=31GPa".
        sections: instead of the file's, as "A=10cm2" or "CS1: A=10cm2, Iy=1000cm4".
        kind: of the members of a drawing.
        tolerance: below which ends of lines in a drawing are one node [m].
        combination: of load cases, whose factors they get; left out, each has the factor 1.

    Raises:
        ImportRefused: a wrong model would come of it; its notes are the complete list.
        InputError: it cannot be read at all.
        MissingPackageError: drawings and workbooks need `rga[formats]`.
    """
    chosen = Chosen(
        units, up, plane, tuple(accept), tuple(without), read_materials(materials),
        read_sections(sections), kind, tolerance, combination,
    )  # fmt: skip
    try:
        draft, where = _read(source, chosen)
    except RecursionError:
        raise InputError("it is nested too deeply", str(source)[:80], "flatten it") from None
    if plane is not None:
        draft.make_plane(plane)
    model = draft.model(where)
    return ImportedModel(model, draft.notes.listed(), draft.counts(), draft.load_sums(model))


def _read(source: Any, chosen: Chosen) -> tuple[ModelDraft, str]:
    """The draft of a source, and where it is from."""
    if isinstance(source, str | Path):
        path = Path(source)
        return _read_path(path, chosen), str(path)
    from rga.importing.pynite import is_pynite, read_pynite

    if is_pynite(source):
        name = type(source).__name__
        return read_pynite(source, name, chosen), name
    if isinstance(source, Sequence) and all(isinstance(one, str | Path) for one in source):
        return _read_csv([Path(one) for one in source], chosen), str(source[0])
    raise InputError(
        f"{type(source).__name__} is nothing that can be read", "source",
        "give a path, paths of tables, or a PyNite model",
    )  # fmt: skip


def _read_path(path: Path, chosen: Chosen) -> ModelDraft:
    try:
        return _read_csv([path], chosen) if path.is_dir() else _read_file(path, chosen)
    except InputError as error:
        if not error.where.startswith(("line ", "lines ")):
            raise
        # Notes stand below the name of the file, an error stands alone.
        raise InputError(error.what, f"{path}, {error.where}", error.remedy) from None


def _read_file(path: Path, chosen: Chosen) -> ModelDraft:
    suffix = path.suffix.lower()
    if suffix in (".tcl", ".py"):
        from rga.importing.pynite import read_pynite, read_pynite_script, says_pynite

        if suffix == ".py" and says_pynite(path):
            made, said = read_pynite_script(path, chosen.without)
            draft = read_pynite(made, path.stem, chosen)
            for words, where in made.unfollowed:
                draft.notes.refuse(
                    where, words, "write it as PyNite's add_... and def_...", "partial"
                )
            for words, where in said:
                draft.notes.say("assumed", where, words)
            return draft
        from rga.importing.opensees import read_opensees

        return read_opensees(path, chosen)
    if suffix in (".s2k", ".$2k"):
        from rga.importing.sap2000 import read_sap2000

        return read_sap2000(path, chosen)
    if suffix == ".dxf":
        from rga.importing.dxf import read_dxf

        return read_dxf(path, chosen)
    if suffix in (".xlsx", ".xlsm"):
        return _read_workbook(path, chosen)
    if suffix == ".csv":
        return _read_csv([path.parent], chosen)
    raise InputError(f"no reader knows {suffix or 'a file without suffix'}", str(path), KINDS)


def _read_workbook(path: Path, chosen: Chosen) -> ModelDraft:
    from rga.importing.saf import is_saf, read_saf
    from rga.importing.tables import is_tables, read_tables
    from rga.importing.workbook import read_workbook

    sheets = read_workbook(path)
    if is_saf(sheets):
        return read_saf(path, sheets, chosen)
    if is_tables(sheets):
        return read_tables(sheets, path, chosen)
    raise InputError(
        f"its sheets are those of no structure: {', '.join(sheets)[:80]}", str(path),
        "name them nodes, members, sections, materials, supports, loads, or export SAF",
    )  # fmt: skip


def _read_csv(places: list[Path], chosen: Chosen) -> ModelDraft:
    from rga.importing.tables import read_tables
    from rga.importing.workbook import read_csv_folder

    paths = [
        path
        for place in places
        for path in (sorted(place.glob("*.csv")) if place.is_dir() else [place])
    ]
    if not paths:
        raise InputError("there is no table (.csv) in it", str(places[0]), KINDS)
    return read_tables(read_csv_folder(paths), places[0], chosen)
