"""`rga example`: a shipped sample to try things on."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rga.errors import InputError


class SampleName(StrEnum):
    """The samples that are shipped."""

    footbridge = "footbridge"
    roof = "roof"
    portal = "portal"
    mast = "mast"
    crane = "crane"


def example(
    name: Annotated[SampleName, typer.Argument(metavar="footbridge|roof|portal|mast|crane")],
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="New or empty directory to write it to.")
    ],
) -> None:
    """Write a sample: a model, what was measured (of the crane its modes), and a hidden cause."""
    from rga.cli.output import whole_directory
    from rga.samples import sample_files

    if directory.is_dir() and any(directory.iterdir()):
        raise InputError("the directory is not empty", str(directory), "name a new one")
    with whole_directory(directory) as draft:
        for file, content in sample_files(name.value).items():
            (draft / file).write_bytes(content)
    typer.echo(f"{directory / 'README.txt'} says what it is and what to try")
