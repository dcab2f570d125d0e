"""Verdicts in plain words."""

import pytest

from made_findings import findings
from rga.findings.phrases import verdict_sentence

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
