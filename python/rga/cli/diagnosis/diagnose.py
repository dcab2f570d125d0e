"""`rga diagnose`: what is wrong, why, where, and how sure."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rga.cli.options import (
    CriteriaFile,
    JsonTarget,
    MappingFile,
    ModalFile,
    ModelFile,
    OutputDirectory,
    PrintPdf,
    RecordFilesIfAny,
    Seed,
)
from rga.errors import InputError, ReportError

if TYPE_CHECKING:
    from rga.findings import Findings

    Progress = Callable[[str, float], None]


def diagnose(
    model: ModelFile,
    output: OutputDirectory,
    record: RecordFilesIfAny = None,
    modal: ModalFile = None,
    mapping: MappingFile = None,
    criteria: CriteriaFile = None,
    seed: Seed = 0,
    json: JsonTarget = None,
    pdf: PrintPdf = False,
) -> None:
    """Diagnose what the model gets wrong of a record, of measured modes, or of both together."""
    from rga.cli.output import check_targets
    from rga.cli.reading import read_record
    from rga.findings.criteria import load_criteria
    from rga.model import load_model
    from rga.outputs import check_outputs
    from rga.records.modal.read import load_modal_record

    if not record and modal is None:
        raise InputError(
            "there is nothing to compare the model with",
            "rga diagnose",
            "give a RECORD, measured modes with --modal, or both",
        )
    if not record and mapping is not None:
        raise InputError("a modal record is read without a mapping", "--import", "leave it out")
    structure = load_model(model)
    chosen = None if criteria is None else load_criteria(criteria)
    measured = read_record(record, structure, mapping) if record else None
    modes = None if modal is None else load_modal_record(modal, structure)
    check_outputs(output)
    check_targets(json)
    # Not needed before the input is known to be good, and slow to import.
    from rga.diagnosis import diagnose as of_record
    from rga.diagnosis import diagnose_modes

    def found(progress: "Progress") -> "Findings":
        if measured is not None:
            return of_record(
                structure, measured, modal=modes, criteria=chosen, seed=seed, progress=progress
            )
        assert modes is not None  # one of both was given
        return diagnose_modes(structure, modes, criteria=chosen, seed=seed, progress=progress)

    _write(output, found, measured.warnings if measured is not None else [], json, pdf)


def _write(
    output: Path,
    found: "Callable[[Progress], Findings]",
    told: list[str],
    target: str | None,
    pdf: bool,
) -> None:
    """Write findings, extended model and report, and say the verdict.

    Args:
        output: the directory.
        found: makes the findings.
        told: warnings that have been told.
        target: of the findings as JSON.
        pdf: whether the report is printed as well.
    """
    import json

    from rga.cli.output import whole_directory, write_json
    from rga.cli.progress import shown_progress
    from rga.report.pdf import write_pdf

    fault: ReportError | None = None
    with whole_directory(output) as draft:
        with shown_progress() as progress:
            findings = found(progress)
        try:
            report = findings.write(draft)
            if pdf:
                write_pdf(report, draft / "report.pdf")
        except ReportError as error:
            fault = error
        content = json.loads((draft / "findings.json").read_text(encoding="utf-8"))
    for warning in findings.warnings:
        if warning not in told:
            typer.echo(f"warning: {warning}", err=True)
    if target is not None:
        write_json(content, target)
    if target != "-":
        typer.echo(f"Verdict: {findings.verdict}. {findings.sentence()}")
    if fault is not None:
        raise ReportError(fault.reason, output) from fault
    if target != "-":
        typer.echo(f"The report is {output / 'report.html'}.")
