"""`rga import`: a model of another program becomes a model file."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rga.cli.options import JsonTarget, OutputFile, decimal

if TYPE_CHECKING:
    from rga.importing import ImportedModel, ImportNote


class MemberKinds(StrEnum):
    """Kinds of members."""

    truss = "truss"
    frame = "frame"


class Up(StrEnum):
    """Axes that may point up."""

    y = "y"
    z = "z"


class Plane(StrEnum):
    """Planes of a model."""

    xy = "xy"
    xz = "xz"
    yz = "yz"


Source = Annotated[
    Path,
    typer.Argument(
        metavar="FILE",
        help="OpenSees or PyNite script (.tcl, .py), SAF or tables (.xlsx, folder of .csv), "
        "SAP2000 (.s2k), drawing (.dxf).",
    ),
]
UnitsText = Annotated[
    str | None,
    typer.Option("--units", help='Of a file that does not state them: "kip, in", "kN, m", "mm".'),
]
UpAxis = Annotated[Up | None, typer.Option("--up", help="Axis of a model in space that points up.")]
PlaneName = Annotated[
    Plane | None, typer.Option("--plane", help="Make it a model of this plane of rga's axes.")
]
Linear = Annotated[
    bool, typer.Option("--accept-linear", help="Read what is of second order as first order.")
]
Partial = Annotated[bool, typer.Option("--accept-partial", help="Leave out what cannot be read.")]
Values = Annotated[
    bool, typer.Option("--accept-values", help="Take values that look wrong as they are.")
]
Without = Annotated[
    list[str] | None,
    typer.Option(
        "--without", metavar="NAME", help="A file that a script reads and needs not; repeatable."
    ),
]
Materials = Annotated[
    list[str] | None,
    typer.Option(
        "--material", metavar="TEXT", help='As "E=210GPa, nu=0.3" or "MAT1: E=31GPa"; repeatable.'
    ),
]
Sections = Annotated[
    list[str] | None,
    typer.Option(
        "--section", metavar="TEXT", help='As "A=10cm2" or "CS1: A=10cm2, Iy=9cm4"; repeatable.'
    ),
]
MemberKind = Annotated[
    MemberKinds | None, typer.Option("--kind", help="Of the members of a drawing.")
]
Tolerance = Annotated[
    float | None,
    typer.Option(
        "--tolerance",
        metavar="M",
        parser=decimal(0.0),
        help="Below which ends of lines in a drawing are one node (m).",
    ),
]
Combination = Annotated[
    str | None, typer.Option("--combination", help="Of load cases, whose factors they get.")
]


def import_model(
    source: Source,
    output: OutputFile,
    units: UnitsText = None,
    up: UpAxis = None,
    plane: PlaneName = None,
    accept_linear: Linear = False,
    accept_partial: Partial = False,
    accept_values: Values = False,
    without: Without = None,
    material: Materials = None,
    section: Sections = None,
    kind: MemberKind = None,
    tolerance: Tolerance = None,
    combination: Combination = None,
    json: JsonTarget = None,
) -> None:
    """Read a model of another program, and say what was dropped or taken for granted.

    Scripts are read and never run. Where a wrong model would come of a file none is written, and
    the exit code is 2.
    """
    from rga.cli.output import write_json
    from rga.errors import InputError
    from rga.importing import ImportRefused, import_model
    from rga.model import write_model

    if output.suffix.lower() != ".json":
        raise InputError("a model is written as JSON", str(output), "name a .json file")
    accepted: list[Literal["linear", "partial", "values"]] = []
    accepted += ["linear"] if accept_linear else []
    accepted += ["partial"] if accept_partial else []
    accepted += ["values"] if accept_values else []
    try:
        found = import_model(
            source,
            units=units,
            up=None if up is None else up.value,
            plane=None if plane is None else plane.value,
            accept=accepted,
            without=without or (),
            materials=material or (),
            sections=section or (),
            kind=None if kind is None else kind.value,
            tolerance=tolerance,
            combination=combination,
        )
    except ImportRefused as refused:
        if json is not None:
            write_json(_content(refused.counts, refused.notes, None), json)
        if json != "-":
            _show(refused.counts, refused.notes)
        grave = sum(note.severity in ("refused", "question") for note in refused.notes)
        raise InputError(
            f"no model is written: {grave} thing{'s' * (grave > 1)} would make it wrong",
            str(source),
            "see what is listed as refused or question",
        ) from None
    write_model(found.model, output)
    if json is not None:
        write_json(_content(found.counts, found.notes, found), json)
    if json != "-":
        _show(found.counts, found.notes)
        for case, force in found.load_sums.items():
            total = ", ".join(f"{value / 1000:.6g}" for value in force)
            typer.echo(f"load {case}: {total} kN in all along x, y, z")
        typer.echo(f"The model is {output}.")


def _content(
    counts: dict[str, int], notes: "list[ImportNote]", found: "ImportedModel | None"
) -> dict[str, Any]:
    from dataclasses import asdict

    sums = {} if found is None else {case: list(sum_) for case, sum_ in found.load_sums.items()}
    return {
        "written": found is not None,
        "counts": counts,
        "load_sums_N": sums,
        "notes": [asdict(note) for note in notes],
    }


def _show(counts: dict[str, int], notes: "list[ImportNote]") -> None:
    shown = dict(counts)
    cut, frames = shown.pop("frames cut", 0), shown.pop("frames", 0)
    parts = ", ".join(f"{count} {kind}" for kind, count in shown.items() if count)
    if cut:
        typer.echo(f"{frames} frames, {cut} of them cut: {counts['members']} members")
    typer.echo(parts or "nothing")
    for note in notes:
        typer.echo(str(note))
