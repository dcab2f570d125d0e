"""A record as a command reads it, and what is said of it."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rga.model import Model
    from rga.records import Record


def read_record(files: Sequence[Path], model: "Model", mapping: Path | None) -> "Record":
    """Read a record, and say what was assumed of its files and what is wrong with them.

    Raises:
        InputError: it cannot be used as it stands.
    """
    from rga.records import load_record

    record = load_record(files, model, mapping)
    for note in record.notes:
        typer.echo(f"note: {note}", err=True)
    for warning in record.warnings:
        typer.echo(f"warning: {warning}", err=True)
    return record
