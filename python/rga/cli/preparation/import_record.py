"""`rga import-record`: a first import.toml from loggers' files."""

from pathlib import Path
from typing import Annotated

import typer

Files = Annotated[
    list[Path],
    typer.Argument(metavar="FILES", help="Files of one logger or of several, of any format."),
]
ModelOption = Annotated[
    Path, typer.Option("--model", metavar="MODEL", help="Model file: it names the channels.")
]
MappingOutput = Annotated[
    Path | None,
    typer.Option(
        "-o", "--output", metavar="FILE", help="The mapping; left out, import.toml beside FILES."
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Replace a mapping that is there.")]


def import_record(
    files: Files, model: ModelOption, output: MappingOutput = None, force: Force = False
) -> None:
    """Look at loggers' files, and write what is guessed of them as a first import.toml.

    The exit code is 2 where the record cannot be read by it as it stands: what is to be filled in
    or mended is said.
    """
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from rga.cli.output import whole_file
    from rga.errors import InputError
    from rga.model import load_model
    from rga.records.drafting import draft_mapping
    from rga.records.mapping import MAPPING_NAME

    structure = load_model(model)
    target = output or files[0].parent / MAPPING_NAME
    if target.exists() and not force:
        raise InputError("the mapping is there already", str(target), "name another, or --force")
    draft = draft_mapping(files, structure, target.parent)
    with whole_file(target) as whole:
        whole.write_text(draft.toml, encoding="utf-8")
    table = Table("channel", "column", "why")
    for match in draft.matched:
        table.add_row(*(Text(cell) for cell in (match.name, match.column, match.why)))
    Console().print(table)
    for doubt in draft.doubts:
        typer.echo(f"doubt: {doubt}")
    if draft.fault is not None:
        typer.echo(f"To fill in, before the record is read: {draft.fault}")
        typer.echo(f"Mend {target} or the files there, then: rga check {model} {target}")
        raise typer.Exit(2)
    typer.echo(f"Check {target}, and give it as the record: rga diagnose {model} {target} -o DIR")
