"""`rga diagnose`: what is wrong, why, where, and how sure."""

from pathlib import Path

import typer

from rga.cli.options import (
    CriteriaFile,
    JsonTarget,
    MappingFile,
    ModelFile,
    OutputDirectory,
    PrintPdf,
    RecordFiles,
    Seed,
)
from rga.errors import ReportError


def diagnose(
    model: ModelFile,
    record: RecordFiles,
    output: OutputDirectory,
    mapping: MappingFile = None,
    criteria: CriteriaFile = None,
    seed: Seed = 0,
    json: JsonTarget = None,
    pdf: PrintPdf = False,
) -> None:
    """Diagnose what the model gets wrong of a record."""
    diagnose_into(output, model, record, mapping, criteria, seed, json, pdf)


def diagnose_into(
    output: Path,
    model: Path,
    record: list[Path],
    mapping: Path | None,
    criteria: Path | None,
    seed: int,
    target: str | None,
    pdf: bool,
) -> None:
    """Write findings, extended model and report, and say the verdict."""
    import json

    from rga.cli.output import check_targets, whole_directory, write_json
    from rga.cli.progress import shown_progress
    from rga.cli.reading import read_record
    from rga.findings.criteria import load_criteria
    from rga.model import load_model
    from rga.outputs import check_outputs

    structure = load_model(model)
    chosen = None if criteria is None else load_criteria(criteria)
    measured = read_record(record, structure, mapping)
    check_outputs(output)
    check_targets(target)
    # Not needed before the input is known to be good, and slow to import.
    from rga.diagnosis import diagnose
    from rga.report.pdf import write_pdf

    fault: ReportError | None = None
    with whole_directory(output) as draft:
        with shown_progress() as progress:
            findings = diagnose(structure, measured, criteria=chosen, seed=seed, progress=progress)
        try:
            report = findings.write(draft)
            if pdf:
                write_pdf(report, draft / "report.pdf")
        except ReportError as error:
            fault = error
        content = json.loads((draft / "findings.json").read_text(encoding="utf-8"))
    for warning in findings.warnings:
        if warning not in measured.warnings:
            typer.echo(f"warning: {warning}", err=True)
    if target is not None:
        write_json(content, target)
    if target != "-":
        typer.echo(f"Verdict: {findings.verdict}. {findings.sentence()}")
    if fault is not None:
        raise ReportError(fault.reason, output) from fault
    if target != "-":
        typer.echo(f"The report is {output / 'report.html'}.")
