"""`rga run`: the main job."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import (
    JsonTarget,
    MappingFile,
    ModelFile,
    OutputDirectory,
    PrintPdf,
    RecordFiles,
    Seed,
)

if TYPE_CHECKING:
    from rga.cli.progress import Shown
    from rga.model import Model
    from rga.records import Record
    from rga.twin import Event
    from rga.twin.runner import Running

Level = Annotated[
    str | None,
    typer.Option(
        metavar="A|B|C",
        help="A calibrates once, B also recalibrates, C also stores contexts and states (default).",
    ),
]
SettingsFile = Annotated[
    Path | None,
    typer.Option("--settings", metavar="FILE", help="Settings of the run (JSON or TOML)."),
]
RepositoryUrl = Annotated[
    str | None,
    typer.Option(
        "--repository",
        metavar="URL",
        help="PostgreSQL database for the repository, instead of twin.sqlite in DIR.",
    ),
]


def run(
    model: ModelFile,
    record: RecordFiles,
    output: OutputDirectory,
    mapping: MappingFile = None,
    seed: Seed = 0,
    level: Level = None,
    settings: SettingsFile = None,
    repository: RepositoryUrl = None,
    json: JsonTarget = None,
    pdf: PrintPdf = False,
) -> None:
    """Calibrate a twin, watch its gap, recalibrate, diagnose and report.

    A run that was interrupted goes on where it stood; one that had ended is not done again.
    """
    from rga.cli.operation.settings import read_settings
    from rga.cli.output import check_targets, write_json
    from rga.cli.progress import shown_progress
    from rga.cli.reading import read_record
    from rga.model import load_model

    structure = load_model(model)
    measured = read_record(record, structure, mapping)
    chosen = read_settings(settings, level)
    check_targets(json)
    for warning in _replaced(output, structure, measured, seed):
        typer.echo(f"warning: {warning}", err=True)
    # Not needed before the input is known to be good, and slow to import.
    from rga.jobs.run import run as run_twin

    quiet = json == "-"
    with shown_progress() as progress:
        outcome = run_twin(
            structure,
            measured,
            output,
            settings=chosen,
            seed=seed,
            repository=repository,
            progress=progress,
            watch=None if quiet else _News(progress),
        )
    findings = outcome.findings
    for warning in findings.warnings:
        if warning not in measured.warnings:
            typer.echo(f"warning: {warning}", err=True)
    if json is not None:
        write_json(findings.model_dump(mode="json"), json)
    if pdf:
        from rga.report.pdf import write_pdf

        write_pdf(output / "report.html", output / "report.pdf")
    if not quiet:
        typer.echo(f"Verdict: {findings.verdict}. {findings.sentence()}")
        typer.echo(f"The report is {output / 'report.html'}.")


def _replaced(output: Path, model: "Model", record: "Record", seed: int) -> list[str]:
    """In words, that a directory holds the results of another run."""
    from rga.errors import InputError
    from rga.findings.load import load_findings
    from rga.inputs import protected_inputs

    try:
        # They are no input of this run, which may replace them.
        with protected_inputs():
            kept = load_findings(output / "findings.json")
    except InputError:
        return []
    of_both = {
        "model": (kept.model_sha256, model.sha256),
        "record": (kept.record_sha256, record.sha256),
        "seed": (kept.seed, seed),
    }
    others = [name for name, (old, new) in of_both.items() if old != new]
    if not others:
        return []
    which = " and ".join(others)
    return [f"{output} holds the results of a run with another {which}: this run replaces them"]


class _News:
    """Shows what happens: a line for each event, and a live line for where the run stands."""

    def __init__(self, progress: "Shown") -> None:
        self._progress = progress
        #: events that were shown; None before the first step
        self._told: int | None = None

    def __call__(self, running: "Running") -> None:
        if self._told is None:
            self._told = 0
            if running.resumed_at is not None:
                # What happened before may not have been shown when the run was killed.
                for event in running.history().events[: -len(running.events) or None]:
                    typer.echo(_line(event))
                typer.echo(f"The run goes on at row {running.resumed_at}.")
        for event in running.events[self._told :]:
            typer.echo(_line(event))
        self._told = len(running.events)
        version = f"model version {running.version}"
        live = f"row {running.row} of {running.rows}, gap {running.gap:.3g}, {version}"
        if running.out_of_sync:
            live += ", out of sync"
        self._progress.describe("stream", live)


def _line(event: "Event") -> str:
    change = ""
    head = f"{event.time}  row {event.row}  {event.kind}"
    if event.kind == "recalibration":  # its words have the figures that decide
        return f"{head}: {event.words}"
    if event.gap_before is not None and event.gap_after is not None:
        change = f" (gap {event.gap_before:.3g} -> {event.gap_after:.3g})"
    elif event.gap_after is not None:
        change = f" (gap {event.gap_after:.3g})"
    return f"{head}: {event.words}{change}"
