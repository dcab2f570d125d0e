"""What a structure does otherwise than when the twin was calibrated: a diagnosis of the change."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis import diagnose
from rga.findings import Findings
from rga.findings.criteria import Criteria
from rga.inference import Joint, Unknowns
from rga.model import Model
from rga.model.effect import seconds
from rga.model.parameter import listed
from rga.records import Record
from rga.twin.calibration.correction import Correction
from rga.twin.versions import beyond

Progress = Callable[[str, float], None]


def diagnose_change(
    model: Model,
    record: Record,
    found: Joint,
    correction: Correction,
    *,
    since: float,
    criteria: Criteria,
    seed: int,
    progress: Progress,
) -> Findings | None:
    """Diagnose a record on the twin as a calibration corrected it.

    What was not as in the model from the beginning no longer hides what came later. A cause that
    was there in the calibration is not seen. Under other loads the twin is off by more than in the
    rows that it was fitted to: the scatter is that of these rows with sensors as they read. A
    sensor that would be off from the beginning was corrected wrongly, and is taken as it reads.

    Args:
        model: as it was given.
        record: measured data.
        found: what the calibration found of the model.
        correction: the same as the twin took it over.
        since: clock at the end of the calibration [s]: a change begins later.
        criteria: of the diagnosis.
        seed: of the diagnosis.
        progress: called with a stage and the share of it that is done.

    Returns:
        Findings about the model as it was given; None where they name no cause that begins later.
    """
    corrected = _structure(model, found)
    calibrated = record.rows(record.origin + record.time <= since)
    calm = replace(calibrated, readings=calibrated.readings - _offsets(calibrated, found))

    def diagnosed(readings: Record) -> Findings:
        return diagnose(
            corrected,
            readings,
            parts=model,
            calm=calm,
            criteria=criteria,
            seed=seed,
            progress=progress,
        )

    sound = _without_sensor_errors(record, found, correction, set())
    findings = diagnosed(sound)
    wrongly = _off_from_the_beginning(findings, since)
    again = _without_sensor_errors(record, found, correction, wrongly)
    if not np.allclose(again.readings, sound.readings, rtol=1e-9, atol=0.0, equal_nan=True):
        findings = diagnosed(again)
    account = findings.account
    effects = {name: account.extended.effects[name] for name in beyond(corrected, account.extended)}
    if not any(_later(one.onset, since) for one in effects.values()):
        return None
    extended = model.extended(effects)
    words = (
        "causes are what has changed since the calibration, which had brought the model to the "
        "structure and the sensors as they were then: gaps and curves are of that twin"
    )
    told = findings.model_copy(
        update={"warnings": [*findings.warnings, words], "model_sha256": model.sha256}
    )
    told._account = replace(account, model=model, extended=extended)
    return told


def in_doubt(findings: Findings) -> Findings:
    """Findings without a cause while the twin is in doubt: they calm nobody."""
    words = "the twin is in doubt since a recalibration, and no cause of that was found"
    change: dict[str, object] = {"warnings": [*findings.warnings, words]}
    if findings.verdict == "nothing_wrong":
        unexplained = findings.unexplained.model_copy(update={"looks_like": words})
        change |= {"verdict": "unknown", "unexplained": unexplained}
    return findings.model_copy(update=change)


def _structure(model: Model, found: Joint) -> Model:
    """The model with its structure as it was found; what was not looked for is as given."""
    unknowns = Unknowns(model)
    value, *_ = found.about(unknowns)
    return unknowns.at(value[: len(unknowns.centre)])


def _off_from_the_beginning(findings: Findings, since: float) -> set[str]:
    """Sensors that are named without a change of theirs since."""
    own = [one.effect for one in findings.causes if not _later(one.effect.get("onset"), since)]
    return {name for one in own if "sensor" in one for name in listed(one["sensor"])}


def _later(onset: str | float | None, since: float) -> bool:
    return onset is not None and seconds(onset) > since


def _without_sensor_errors(
    record: Record, found: Joint, correction: Correction, as_read: set[str]
) -> Record:
    """The record as sound sensors would have read it, the zero of the logger taken off.

    Args:
        record: measured data.
        found: what the calibration found of the sensors.
        correction: the same as the twin took it over.
        as_read: sensors that are not corrected.
    """
    gains, offsets = correction.of_sensors(tuple(record.sensors))
    # What a sensor reads beside its gains has the zero in it.
    zero = _offsets(record, found) - offsets
    sound = (record.readings - offsets) / gains - zero
    kept = np.array([name in as_read for name in record.sensors])
    return replace(record, readings=np.where(kept, record.readings, sound))


def _offsets(record: Record, found: Joint) -> FloatArray:
    """What sensors were found to read beside their gains, the zero of the logger left out."""
    own = dict(zip(found.unknowns.model.sensors, found.offsets.tolist(), strict=True))
    return np.array([own.get(name, 0.0) for name in record.sensors])
