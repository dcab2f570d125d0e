"""`rga schema`: the JSON Schema of the files."""

from enum import StrEnum
from importlib import import_module
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
    serve = "serve"
    faults = "faults"
    packet = "packet"


#: where the schema of each is made, or the class that has it
HOMES = {
    Format.model: ("rga.model", "model_schema"),
    Format.record: ("rga.records", "record_schema"),
    Format.findings: ("rga.findings", "Findings"),
    Format.criteria: ("rga.findings.criteria", "Criteria"),
    Format.import_toml: ("rga.records.mapping", "mapping_schema"),
    Format.settings: ("rga.twin.settings", "Settings"),
    Format.serve: ("rga.operation.configuration", "Configuration"),
    Format.faults: ("rga.operation.feeding.faults", "Faults"),
    Format.packet: ("rga.operation.packets.native", "packet_schema"),
}


def schema(
    of: Annotated[Format, typer.Argument(metavar="|".join(Format), help="What is described.")],
    json: JsonTarget = "-",
) -> None:
    """Print the JSON Schema of a file, of a service, or of what loggers send.

    `import` is import.toml, `settings` are those of a run, `serve` is what `rga serve` reads,
    `faults` what `rga feed` does, and `packet` what loggers send.
    """
    from rga.cli.output import write_json

    module, name = HOMES[of]
    described = getattr(import_module(module), name)
    content = getattr(described, "model_json_schema", described)()
    if of is Format.criteria:
        # A file may name the schema by which an editor completes it.
        content["properties"]["$schema"] = {"type": "string"}
    write_json(content, json or "-")
