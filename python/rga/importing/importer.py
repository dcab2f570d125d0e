"""`import_model`: which reader a source needs."""

from collections.abc import Collection
from pathlib import Path
from typing import Any, Literal

from rga.errors import InputError
from rga.importing.draft import Draft
from rga.importing.imported import ImportedModel
from rga.importing.notes import Acceptance
from rga.importing.units import Units

SUFFIXES = ".tcl, .py (OpenSees), .xlsx (SAF, tables), .csv in a folder, .s2k, .dxf"


def import_model(
    source: Any,
    *,
    units: str | None = None,
    up: Literal["y", "z"] | None = None,
    accept: Collection[Acceptance] = (),
    without: Collection[str] = (),
    materials: Collection[str] = (),
) -> ImportedModel:
    path = Path(source)
    if path.suffix.lower() in (".s2k", ".$2k"):
        from rga.importing.sap2000 import read_sap2000

        draft = read_sap2000(
            path, None if units is None else Units.read(units, "units"), frozenset(accept)
        )
        model = draft.model(str(path))
        return ImportedModel(model, draft.notes.listed(), draft.counts())
    if path.suffix.lower() == ".xlsx":
        from rga.importing.materials import read_given
        from rga.importing.saf import read_saf

        draft = read_saf(path, frozenset(accept), [read_given(m, "material") for m in materials])
        model = draft.model(str(path))
        return ImportedModel(model, draft.notes.listed(), draft.counts())
    if path.suffix.lower() not in (".tcl", ".py"):
        raise InputError("no reader knows this kind of file", str(path), f"give {SUFFIXES}")
    from rga.importing.opensees import read_opensees

    system = None if units is None else Units.read(units, "units")
    draft: Draft = read_opensees(path, system, frozenset(accept), up, frozenset(without))
    model = draft.model(str(path))
    return ImportedModel(model, draft.notes.listed(), draft.counts())
