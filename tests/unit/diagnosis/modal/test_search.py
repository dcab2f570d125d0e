"""What a search ends with is better than what could stand in its place."""

from dataclasses import replace

import numpy as np
import pytest

from independent.modal_bridge import Hidden, measured
from rga.diagnosis.modal import pipeline, search
from rga.diagnosis.modal.candidates import modal_hypotheses, prospects
from rga.diagnosis.modal.fit import fitted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.findings.criteria import Criteria

SOFT = Hidden(stiffness={"bottom bracing": 0.5})


def test_a_rival_that_is_better_takes_the_place_of_what_was_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model, record = measured(0, SOFT, windows=20)
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    candidates = modal_hypotheses(likelihood.trials)
    (wrong,) = (
        one
        for one in candidates
        if (one.name, one.place.get("group")) == ("member_stiffness", "top bracing")
    )
    first = prospects(likelihood, candidates, [], np.zeros(0), lambda done: None)
    begun = fitted(likelihood, [wrong], [-1.0]), first
    monkeypatch.setattr(search, "_grown", lambda *given: begun)
    found = search.search(likelihood, candidates, Criteria(), lambda stage, done: None)
    (cause,) = found.fit.hypotheses
    assert (cause.name, cause.place["group"]) == ("member_stiffness", "bottom bracing")
    assert found.fit.log_evidence > begun[0].log_evidence
    assert len(found.log_odds) == len(found.rivals) == 1


@pytest.mark.parametrize("doubtful", [0.4, 0.6])
def test_modes_that_may_be_others_in_most_windows_name_nothing(
    monkeypatch: pytest.MonkeyPatch, doubtful: float
) -> None:
    read = ModalReadings.of

    def in_doubt(*given: object) -> ModalReadings:
        own = read(*given)  # type: ignore[arg-type]
        windows = int(doubtful * len(own.time))
        return replace(own, doubtful=windows, in_doubt=own.modes[:2])

    monkeypatch.setattr(pipeline.ModalReadings, "of", in_doubt)
    findings = pipeline.diagnose_modes(*measured(0, SOFT, windows=20))
    assert findings.verdict == ("partial" if doubtful < 0.5 else "unknown")
    assert bool(findings.causes) == (doubtful < 0.5)
    assert "another pairing of the modes found is nearly as probable" in (
        findings.unexplained.looks_like
    )
