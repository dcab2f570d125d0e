"""`rga run`: the main job."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import (
    JsonTarget,
    MappingFile,
    ModalFile,
    ModelFile,
    OutputDirectory,
    PrintPdf,
    RecordFilesIfAny,
    Seed,
)
from rga.errors import InputError

if TYPE_CHECKING:
    from rga.cli.progress import Shown
    from rga.findings import Findings
    from rga.model import Model
    from rga.records import Record
    from rga.twin import Event, Settings
    from rga.twin.runner import Running
    from rga.twin.sync.modes import WatchedModes

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
    output: OutputDirectory,
    record: RecordFilesIfAny = None,
    modal: ModalFile = None,
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
    With --modal in place of a record, natural frequencies are watched, and diagnosed at the end.
    """
    from rga.cli.operation.settings import read_settings
    from rga.cli.output import write_json
    from rga.model import load_model

    if (modal is None) == (not record):
        raise InputError(
            "one record is watched in a run" if record else "there is nothing to watch",
            "rga run",
            "give a RECORD or --modal FILE; `rga diagnose` takes both together",
        )
    structure = load_model(model)
    chosen = read_settings(settings, level)
    if modal is not None:
        for option, given in (("--import", mapping), ("--repository", repository)):
            if given is not None:
                raise InputError(f"{option} says nothing of modes", option, "leave it out")
        findings = _modes_run(structure, modal, output, chosen, seed, json)
    else:
        findings = _twin_run(
            structure, record or [], mapping, output, chosen, seed, repository, json
        )
    if json is not None:
        write_json(findings.model_dump(mode="json"), json)
    if pdf:
        from rga.report.pdf import write_pdf

        write_pdf(output / "report.html", output / "report.pdf")
    if json != "-":
        typer.echo(f"Verdict: {findings.verdict}. {findings.sentence()}")
        typer.echo(f"The report is {output / 'report.html'}.")


def _twin_run(
    structure: "Model",
    record: list[Path],
    mapping: Path | None,
    output: Path,
    settings: "Settings",
    seed: int,
    repository: str | None,
    json: str | None,
) -> "Findings":
    """A twin on a record of readings: what is found, once its warnings are told."""
    from rga.cli.output import check_targets
    from rga.cli.progress import shown_progress
    from rga.cli.reading import read_record

    measured = read_record(record, structure, mapping)
    check_targets(json)
    for warning in _replaced(output, structure, measured, seed):
        typer.echo(f"warning: {warning}", err=True)
    # Not needed before the input is known to be good, and slow to import.
    from rga.jobs.run import run as run_twin

    with shown_progress() as progress:
        outcome = run_twin(
            structure,
            measured,
            output,
            settings=settings,
            seed=seed,
            repository=repository,
            progress=progress,
            watch=None if json == "-" else _News(progress),
        )
    for warning in outcome.findings.warnings:
        if warning not in measured.warnings:
            typer.echo(f"warning: {warning}", err=True)
    return outcome.findings


def _modes_run(
    structure: "Model",
    modal: Path,
    output: Path,
    settings: "Settings",
    seed: int,
    json: str | None,
) -> "Findings":
    """Modes that are watched: what is found, once the warnings are told."""
    from rga.cli.output import check_targets
    from rga.cli.progress import shown_progress
    from rga.records.modal.read import load_modal_record

    measured = load_modal_record(modal, structure)
    check_targets(json)
    # Not needed before the input is known to be good, and slow to import.
    from rga.jobs.run_modes import run_modes

    with shown_progress() as progress:
        outcome = run_modes(
            structure,
            measured,
            output,
            settings=settings,
            seed=seed,
            progress=progress,
            watch=None if json == "-" else _tell_watch,
        )
    for warning in outcome.findings.warnings:
        if outcome.watched.alarm is None or warning != outcome.watched.alarm.words:
            typer.echo(f"warning: {warning}", err=True)
    return outcome.findings


def _tell_watch(watched: "WatchedModes") -> None:
    """What has become of the frequencies, a line each."""
    last = watched.baseline - 1
    words = f"{watched.baseline} windows say what is usual"
    typer.echo(f"{watched.time[last]}  window {last}  calibration: {words}")
    if watched.alarm is None:
        last = len(watched.time) - 1
        typer.echo(f"{watched.time[last]}  window {last}  no alarm")
    else:
        row = watched.alarm.row
        typer.echo(f"{watched.time[row]}  window {row}  alarm: {watched.alarm.words}")


def _replaced(output: Path, model: "Model", record: "Record", seed: int) -> list[str]:
    """In words, that a directory holds the results of another run."""
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
