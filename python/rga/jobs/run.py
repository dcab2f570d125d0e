"""A run of the twin on a record, from its beginning to its report."""

from collections.abc import Callable
from pathlib import Path

from rga.errors import InputError
from rga.files import made_directory
from rga.given import as_record
from rga.model import Model, as_model
from rga.outputs import check_outputs, write_run
from rga.records import Record, RecordMapping, RecordSource
from rga.twin.calibration.estimator import Learn
from rga.twin.hardware.inbox import INBOX
from rga.twin.outcome import Outcome
from rga.twin.repository.database import FILE_NAME
from rga.twin.runner import Progress, Running, taken_up
from rga.twin.settings import Settings, as_settings


def run(
    model: Model | str | Path,
    record: Record | RecordSource,
    directory: str | Path,
    *,
    mapping: str | Path | RecordMapping | None = None,
    settings: Settings | str | Path | None = None,
    seed: int = 0,
    repository: str | None = None,
    progress: Progress | None = None,
    watch: Callable[[Running], None] | None = None,
    learn: Learn | None = None,
) -> Outcome:
    """Calibrate a twin on a record, watch its gap, recalibrate, diagnose, and report.

    The repository in the directory keeps everything: a run that was interrupted goes on from it
    and ends in the same findings, and one that had ended is not done again.

    Args:
        model: the structure with its effects and sensors, or its file.
        record: measured data, or their file.
        directory: for `findings.json`, `model.json`, `report.html` and the repository.
        mapping: how to read the file of the record, as `load_record` takes it.
        settings: level of integration and the rest, or their file.
        seed: of everything random.
        repository: URL of a PostgreSQL database, instead of the file in the directory.
        progress: called with a stage and the share of it that is done.
        watch: called after every step where the run stands.
        learn: what learns to infer contexts (`rga.twin.Lesson` in, `rga.twin.ContextEstimator`
            out), in place of what the settings name; such a run is not resumed.

    Returns:
        The findings of the closing diagnosis, and the history; both are in the directory too.

    Raises:
        InputError: the model cannot represent what the calibration needs, the record is too
            short, or the repository cannot be used.
        ReportError: the report could not be drawn; findings and model are there, and the same
            call goes on with the report.
    """
    model = as_model(model)
    record, settings = as_record(record, model, mapping), as_settings(settings)
    settings.criteria.record.check_length(len(record))
    directory = made_directory(directory)
    check_outputs(directory)
    if (directory / INBOX).exists():
        raise InputError(
            "a twin that goes on is here", str(directory), "give another directory for this run"
        )
    if repository is not None and "://" not in repository:
        raise InputError(
            f"{repository!r} is no URL of a database",
            "the repository",
            "write postgresql://user@host/database, or leave it out",
        )
    place = repository or directory / FILE_NAME
    with taken_up(model, record, place, settings, seed, progress, learn) as running:
        while running.stage not in ("report", "done"):
            running.step()
            if watch is not None:
                watch(running)
        return concluded(running, directory)


def concluded(running: Running, directory: Path) -> Outcome:
    """What a run ended with, written into a directory unless it is there."""
    if running.stage == "done" and running.is_written(directory):
        return Outcome(running.stored_findings(), running.history())
    outcome = Outcome(running.findings(), running.history())
    write_run(outcome, directory)
    running.end()
    return outcome
