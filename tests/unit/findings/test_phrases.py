"""Verdicts in plain words."""

import pytest

from made_findings import cause, findings
from rga.findings.phrases import verdict_sentence
from rga.findings.schema import Unexplained

LOST = {"kind": "member_stiffness", "member": "m", "factor": {"value": 0.7, "ci90": [0.6, 0.8]}}


@pytest.mark.parametrize(
    ("log_odds", "verdict", "said"),
    [
        (0.2, "nothing_wrong", True),
        (-4.5, "nothing_wrong", True),
        (-6.1, "nothing_wrong", False),
        (0.2, "unknown", False),
    ],
)
def test_what_comes_near_is_not_ruled_out(log_odds: float, verdict: str, said: bool) -> None:
    nothing = {"words": "the model as it is", "effects": [], "log_odds": 0.0, "gap": 1.0}
    lost = {"words": "a loss in m", "effects": [LOST], "log_odds": log_odds, "gap": 1.0}
    found = findings(explanations=(lost, nothing)).model_copy(update={"verdict": verdict})
    sentence = "Not ruled out, and too little to be named: a loss in m."
    assert (sentence in verdict_sentence(found)) == said


@pytest.mark.parametrize("verdict", ["unknown", "partial"])
@pytest.mark.parametrize("against", [True, False])
def test_data_that_decide_too_little_speak_against_nothing(verdict: str, against: bool) -> None:
    left = Unexplained(share=0.5, looks_like="m1 may be m2", speaks_against=against)
    found = findings(*([cause(LOST)] if verdict == "partial" else []))
    said = verdict_sentence(found.model_copy(update={"verdict": verdict, "unexplained": left}))
    assert f"What stays {'unexplained' if against else 'in doubt'}: m1 may be m2." in said
    assert ("Something speaks against the model" in said) == (against and verdict == "unknown")
    cannot = "Nothing speaks against the model, and these data cannot decide whether it is right."
    assert (cannot in said) == (not against and verdict == "unknown")
