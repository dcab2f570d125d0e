"""`rga schema`: the JSON Schema of the files."""

from enum import StrEnum
from typing import Annotated

import typer

from rga.cli.options import JsonTarget


class Format(StrEnum):
    """The files that have a schema."""

    model = "model"
    record = "record"
    findings = "findings"


def schema(
    of: Annotated[Format, typer.Argument(metavar="model|record|findings")], json: JsonTarget = "-"
) -> None:
    """Print the JSON Schema of a model file, a record or the findings."""
    from rga.cli.output import write_json

    if of is Format.model:
        from rga.model import model_schema

        content = model_schema()
    elif of is Format.record:
        from rga.records import record_schema

        content = record_schema()
    else:
        from rga.findings import Findings

        content = Findings.model_json_schema()
    write_json(content, json or "-")
