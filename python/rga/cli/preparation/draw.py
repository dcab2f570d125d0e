"""`rga draw`: a model as a drawing."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Literal

import typer

from rga.cli.options import GivenContexts, ModelFile, decimal, file_to_write, settings


class NamedPart(StrEnum):
    """Parts of a model that have names, one kind or all."""

    nodes = "nodes"
    members = "members"
    sensors = "sensors"
    supports = "supports"
    all = "all"


Drawing = Annotated[
    Path,
    typer.Option(
        "-o", "--output", metavar="FILE", parser=file_to_write,
        help="File for the drawing: .svg, .png, or .html for a page that turns with the mouse.",
    ),
]  # fmt: skip
Names = Annotated[
    list[NamedPart] | None, typer.Option("--names", help="Parts to be named; repeatable.")
]
Loads = Annotated[
    list[str] | None,
    typer.Option("--load", metavar="EFFECT", help="A load to draw instead of all; repeatable."),
]
Deformed = Annotated[bool, typer.Option("--deformed", help="The deformed shape.")]
Scale = Annotated[
    float | None,
    typer.Option(
        "--scale", metavar="TIMES", parser=decimal(), help="By which displacements are enlarged."
    ),
]
Forces = Annotated[
    Literal["N", "V", "M", "T", "Vy", "Vz", "My", "Mz"] | None,
    typer.Option("--forces", help="The diagram of a section force; V and M are in the plane."),
]
LocalAxes = Annotated[bool, typer.Option("--axes", help="Local axes of the members.")]
Sensors = Annotated[
    bool | None,
    typer.Option("--sensors/--no-sensors", help="Sensors; left out with displacements or forces."),
]
Dark = Annotated[bool, typer.Option("--dark", help="For a dark background.")]
Width = Annotated[
    float,
    typer.Option(
        "--width", metavar="INCHES", parser=decimal(), help="Of a sheet; 3.75 suits a phone."
    ),
]


def draw(
    model: ModelFile,
    output: Drawing = Path("drawing.svg"),
    contexts: GivenContexts = None,
    names: Names = None,
    load: Loads = None,
    deformed: Deformed = False,
    scale: Scale = None,
    forces: Forces = None,
    axes: LocalAxes = False,
    sensors: Sensors = None,
    dark: Dark = False,
    width: Width = 10.0,
) -> None:
    """Draw a model: members, supports, loads and sensors, its deformed shape and forces.

    Contexts of loads, displacements and forces that are not given stand at mid-range, or where
    nothing happens there at the upper ends of their ranges.
    """
    from rga.drawing import draw as write
    from rga.model import load_model

    drawn = write(
        load_model(model),
        output,
        width=width,
        names=[part.value for part in names or []],
        sensors=sensors,
        loads=load,
        local_axes=axes,
        deformed=deformed,
        scale=scale,
        forces=forces,
        contexts=settings(contexts, "--contexts"),
        dark=dark,
    )
    typer.echo(f"The drawing is {drawn}.")
