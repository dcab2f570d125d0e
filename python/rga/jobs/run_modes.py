"""The modes of a structure, watched and diagnosed: a run on a modal record."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rga.diagnosis import diagnose_modes
from rga.errors import InputError
from rga.files import made_directory
from rga.findings import Findings
from rga.model import Model, as_model
from rga.outputs import check_outputs, write_findings
from rga.records.modal.read import load_modal_record
from rga.records.modal.record import ModalRecord
from rga.twin.settings import Settings, as_settings
from rga.twin.sync.modes import WatchedModes, watch_modes

Progress = Callable[[str, float], None]
#: settings that say something of modes
USED = {"calibration_rows", "arl0", "criteria"}


@dataclass(frozen=True)
class ModalRun:
    """What a run on a modal record ended with.

    Attributes:
        findings: of the diagnosis of the whole record; among its warnings, what the watch told.
        watched: frequencies, window by window, and the alarm.
    """

    findings: Findings
    watched: WatchedModes


def run_modes(
    model: Model | str | Path,
    record: ModalRecord | str | Path,
    directory: str | Path,
    *,
    settings: Settings | str | Path | None = None,
    seed: int = 0,
    progress: Progress | None = None,
    watch: Callable[[WatchedModes], None] | None = None,
) -> ModalRun:
    """Watch the natural frequencies of a modal record, diagnose the whole of it, and report.

    The first windows say what is usual, as many as `calibration_rows` says: a third of the record
    and 200 at most, unless it is set. Nothing is recalibrated.

    Args:
        model: the structure with its masses, points and modes, or its file.
        record: modes found in windows of time, or their file (`load_modal_record`).
        directory: for `findings.json`, `model.json` and `report.html`.
        settings: `calibration_rows` (windows), `arl0` (windows between false alarms) and
            `criteria`, or their file.
        seed: of everything random.
        progress: called with a stage of the diagnosis and the share of it that is done.
        watch: called with what the watch has seen, before the diagnosis begins.

    Raises:
        InputError: a file cannot be used, the record is too short to say what is usual, or a
            setting says nothing of modes.
        ReportError: the report could not be drawn; findings and model are there.

    >>> import numpy as np
    >>> import rga
    >>> from rga.model.schema import ExpectedMode
    >>> mast = rga.ModelBuilder("mast").add_material("steel", "S355").add_section("tube", "HEB 200")
    >>> mast = mast.add_node("foot").add_node("head", z="6 m").support("foot", "fixed")
    >>> mast = mast.add_member("foot", "head", "tube", kind="frame").mass("head", "500 kg").build()
    >>> modes = {"sway": ExpectedMode(near=1.588), "nod": ExpectedMode(near=2.678)}
    >>> mast = mast.model_copy(update={"modes": modes})
    >>> frequencies = np.tile([1.588, 2.678], (200, 1))  # [Hz], in each window
    >>> frequencies *= 1 + 0.002 * np.random.default_rng(0).standard_normal((200, 2))
    >>> frequencies[160:] *= 0.97
    >>> found = [{"Fn": window} for window in frequencies]
    >>> record = rga.modal_record(found, mast, [], time=[600.0 * k for k in range(200)])
    >>> from tempfile import mkdtemp
    >>> outcome = run_modes(mast, record, mkdtemp())
    >>> # Two modes tell that something changed, and not what.
    >>> outcome.findings.verdict, outcome.watched.baseline, len(outcome.watched.warnings)
    ('unknown', 66, 0)
    """
    model, settings = as_model(model), as_settings(settings)
    idle = sorted(settings.model_fields_set - USED)
    if idle:
        raise InputError(
            f"setting {idle[0]!r} says nothing of modes",
            "settings",
            f"leave it out; of modes {', '.join(sorted(USED))} can be set",
        )
    if not isinstance(record, ModalRecord):
        record = load_modal_record(record, model)
    directory = made_directory(directory)
    check_outputs(directory)
    baseline = settings.pace(int(record.windows.max()) + 1).calibration_rows
    watched = watch_modes(model, record, baseline, arl0=settings.arl0, seed=seed)
    if watch is not None:
        watch(watched)
    findings = diagnose_modes(
        model, record, criteria=settings.criteria, seed=seed, progress=progress
    )
    findings.warnings.extend(watched.told)
    write_findings(findings, directory)
    return ModalRun(findings, watched)
