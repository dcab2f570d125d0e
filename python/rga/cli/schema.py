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
    criteria = "criteria"
    import_toml = "import"
    settings = "settings"


def schema(
    of: Annotated[Format, typer.Argument(metavar="model|record|findings|criteria|import|settings")],
    json: JsonTarget = "-",
) -> None:
    """Print the JSON Schema of a file; `import` is import.toml, `settings` are those of a run."""
    from rga.cli.output import write_json

    if of is Format.model:
        from rga.model import model_schema

        content = model_schema()
    elif of is Format.record:
        from rga.records import record_schema

        content = record_schema()
    elif of is Format.findings:
        from rga.findings import Findings

        content = Findings.model_json_schema()
    elif of is Format.import_toml:
        from rga.records.mapping import mapping_schema

        content = mapping_schema()
    elif of is Format.settings:
        from rga.twin.settings import Settings

        content = Settings.model_json_schema()
    else:
        from rga.findings.criteria import Criteria

        content = Criteria.model_json_schema()
        # A file may name the schema by which an editor completes it.
        content["properties"]["$schema"] = {"type": "string"}
    write_json(content, json or "-")
