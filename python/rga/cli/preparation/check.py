"""`rga check`: what looks wrong of a model, and of a record beside it."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.options import JsonTarget, MappingFile, ModelFile

Record = Annotated[
    list[Path] | None,
    typer.Argument(metavar="[RECORD]...", help="Record to check beside the model, as in diagnose."),
]


def check(
    model: ModelFile, record: Record = None, mapping: MappingFile = None, json: JsonTarget = None
) -> None:
    """Say all that looks wrong of a model, and of a record beside it, each with its remedy.

    The exit code is 2 where there is an error; warnings and notes leave it 0.
    """
    from rga.checking import check as look
    from rga.cli.output import write_json

    checked = look(model, record or None, mapping=mapping)
    if json is not None:
        write_json(checked.content(), json)
    if json != "-":
        typer.echo(str(checked))
    if not checked.ok:
        raise typer.Exit(2)
