"""One diagnosis, its time stage by stage."""

import time
from dataclasses import dataclass

from rga.diagnosis import diagnose
from rga.diagnosis.search.hypothesis import hypotheses
from rga_bench.speed.sized_case import SizedCase

#: stages of a diagnosis as they are called while it works, in their order
STAGES = {
    "reading the contexts": "preparation",
    "estimating the noise": "noise",
    "screening": "screening",
    "looking for": "search",
    "weighing rivals": "search",
    "leaving out channels": "checks",
    "comparing explanations": "comparison",
    "done": "assembly",
}


@dataclass(frozen=True)
class SpeedOutcome:
    """What a diagnosis took.

    Attributes:
        case: that was diagnosed.
        members, hypotheses: how many there were.
        verdict: of the diagnosis.
        kinds: of the causes named.
        seconds: time of one core [s].
        stages: parts of it [s], by stage.
    """

    case: SizedCase
    members: int
    hypotheses: int
    verdict: str
    kinds: list[str]
    seconds: float
    stages: dict[str, float]


def measure(case: SizedCase) -> SpeedOutcome:
    """Draw a case, and diagnose it with everything imported already."""
    model, record = case.draw()
    stages = dict.fromkeys(STAGES.values(), 0.0)
    begun = last = time.process_time()

    def tell(words: str, done: float) -> None:
        nonlocal last
        now = time.process_time()
        stages[next(stage for word, stage in STAGES.items() if words.startswith(word))] += (
            now - last
        )
        last = now

    findings = diagnose(model, record, progress=tell)
    seconds = time.process_time() - begun
    return SpeedOutcome(
        case=case,
        members=len(model.members),
        hypotheses=len(hypotheses(model, record.sensors, set(record.contexts))),
        verdict=findings.verdict,
        kinds=[cause.effect["kind"] for cause in findings.causes],
        seconds=seconds,
        stages=stages,
    )
