"""What a diagnosis makes of a trial's record."""

import time
from dataclasses import dataclass
from typing import Any

from rga.diagnosis import diagnose
from rga.findings import Findings
from rga_bench.diagnosis.hidden import Truth
from rga_bench.diagnosis.judge import FEW_RIVALS, kind_and_place
from rga_bench.faults.base import load
from rga_bench.faults.inject import broken
from rga_bench.faults.trial import FaultTrial

#: verdict where the diagnosis ended with an error
ERROR = "error"


@dataclass(frozen=True)
class FaultOutcome:
    """What became of a trial; what stands in a line of the ledger.

    Attributes:
        id: of the trial.
        base, way, fault: of the trial.
        broken: channels, each with `sensor`, `fault` and first `row`.
        verdict: of the diagnosis; "error": it ended with one.
        causes: each with kind, place and `rivals`.
        found: whether each effect that is known to be hidden is a cause or among few rivals.
        warnings: of the diagnosis, and what it says of all that is left.
        before, after: gap on held-out rows; None: no diagnosis.
        gain: interval of their difference.
        seconds: of the processor that the diagnosis took.
        error: what it ended with.
    """

    id: str
    base: str
    way: str
    fault: str
    broken: list[dict[str, Any]]
    verdict: str
    causes: list[dict[str, Any]]
    found: list[bool]
    warnings: list[str]
    before: float | None
    after: float | None
    gain: tuple[float, float] | None
    seconds: float
    error: str = ""


def judge(trial: FaultTrial) -> FaultOutcome:
    """Break the channels of a record, and diagnose it."""
    sound = load(trial.base, trial.seed)
    record, gone = broken(trial, sound.model, sound.record)
    begun = time.process_time()
    try:
        findings = diagnose(sound.model, record, seed=trial.seed)
    except Exception as error:
        # A diagnosis that breaks down over a broken channel is what is looked for here.
        return FaultOutcome(
            trial.id, trial.base.name, trial.way, trial.fault, gone, ERROR, [],
            [False] * len(sound.hidden), [], None, None, None,
            time.process_time() - begun, f"{type(error).__name__}: {error}",
        )  # fmt: skip
    seconds = time.process_time() - begun
    held_out = findings.gap.held_out
    return FaultOutcome(
        id=trial.id,
        base=trial.base.name,
        way=trial.way,
        fault=trial.fault,
        broken=gone,
        verdict=findings.verdict,
        causes=[
            {
                **kind_and_place(cause.effect),
                "rivals": [kind_and_place(rival) for rival in cause.rivals],
            }
            for cause in findings.causes
        ],
        found=[_found(one, findings) for one in sound.hidden],
        warnings=[*findings.warnings, findings.unexplained.looks_like],
        before=held_out.before,
        after=held_out.after,
        gain=held_out.gain_ci90,
        seconds=seconds,
    )


def _found(hidden: dict[str, Any], findings: Findings) -> bool:
    truth = Truth(hidden["kind"], hidden["place"], {}, None, None, 0.0)
    return any(
        truth.is_at(effect)
        for cause in findings.causes
        if len(cause.rivals) <= FEW_RIVALS
        for effect in (cause.effect, *cause.rivals)
    )
