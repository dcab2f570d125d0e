"""`rga run`: the main job."""

from rga.cli.diagnose import diagnose_into
from rga.cli.options import JsonTarget, MappingFile, ModelFile, OutputDirectory, RecordFile, Seed


def run(
    model: ModelFile,
    record: RecordFile,
    output: OutputDirectory,
    mapping: MappingFile = None,
    seed: Seed = 0,
    json: JsonTarget = None,
) -> None:
    """Calibrate, diagnose and report on a record."""
    diagnose_into(output, model, record, mapping, seed, json)
