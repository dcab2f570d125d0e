"""Explanations as findings hold them, each with why it was kept or rejected."""

from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.assemble.explanations import explanations
from rga.diagnosis.checks.explanations import OnUnseen, Tried
from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import Fit, fit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import Found
from rga.findings.schema import Explanation

SOME = OnUnseen(4.0, 5.0)


@pytest.fixture
def sunk(noisy: Problem) -> Hypothesis:
    return candidate(noisy, "support_settlement", support="east")


@pytest.fixture
def found(noisy: Problem, sunk: Hypothesis) -> Found:
    """A settlement, and a bias that is far from explaining it."""
    change = change_of(noisy, sunk, 0.2)
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change)
    return found_with(problem, [sunk], [candidate(noisy, "sensor_bias", sensor="D3")])


def fitted(found: Found, *hypotheses: Hypothesis) -> Fit:
    return fit(found.problem, found.base, hypotheses, [0.1] * len(hypotheses))


def reported(found: Found, prepared: PreparedRecord, *tried: Tried) -> list[Explanation]:
    nothing = Tried(fitted(found), 9.0, OnUnseen(9.0, 0.0))
    return explanations([nothing, *tried], found, prepared.record)


def test_the_likeliest_comes_first_and_nothing_tried_is_nothing(
    found: Found, prepared: PreparedRecord
) -> None:
    gains = Tried(None, 1.2, OnUnseen(9.0, 0.0))
    named = Tried(found.fit, 1.0, OnUnseen(1.1, 20.0))
    page = reported(found, prepared, gains, named)
    assert [one.log_odds for one in page] == sorted((one.log_odds for one in page), reverse=True)
    assert page[0].remark == "what is named"
    assert page[0].effects[0]["kind"] == "support_settlement"
    assert page[0].gap_unseen_channels == 1.1
    words = {one.words: one.remark for one in page}
    assert words["the model as it is"] == "what every other explanation is measured against"
    assert words["a free gain on every channel"].startswith("fits, and says nothing")
    assert explanations([], found, prepared.record) == []


def test_why_another_is_rejected(found: Found, prepared: PreparedRecord) -> None:
    far = found.alternatives[0][0].fit
    (one,) = (o for o in reported(found, prepared, Tried(far, 5.0, SOME)) if "bias" in o.words)
    assert one.remark.startswith("rejected (-")
    near = replace(far, log_evidence=found.fit.log_evidence - 0.5)
    (one,) = (o for o in reported(found, prepared, Tried(near, 5.0, SOME)) if "bias" in o.words)
    assert one.remark.startswith("cannot be separated from what is named (-0.5")
    rival = replace(found.alternatives[0][0], behind=1.0)
    hanging = replace(found, alternatives=((rival,),))
    (one,) = (o for o in reported(hanging, prepared, Tried(far, 5.0, SOME)) if "bias" in o.words)
    assert "hangs on one channel" in one.remark


def test_what_is_added_to_the_causes_is_weighed_by_what_it_earns(
    found: Found, prepared: PreparedRecord, sunk: Hypothesis, noisy: Problem
) -> None:
    both = fitted(found, sunk, candidate(noisy, "sensor_bias", sensor="D1"))
    (one,) = (o for o in reported(found, prepared, Tried(both, 1.0, SOME)) if "bias" in o.words)
    assert one.remark.startswith("what is added earns -")


def test_unseen_channels_and_unlikely_values_are_remarked(
    found: Found, prepared: PreparedRecord
) -> None:
    far = found.alternatives[0][0].fit
    better, useless = (
        "predicts channels that were left out better",
        "does not help channels that it was not fitted to",
    )
    named = Tried(found.fit, 1.0, OnUnseen(3.0, 20.0))
    # A small gap by a prediction that says little is no better one.
    for unseen, remarked in (
        (OnUnseen(1.0, 30.0), (True, False)),
        (OnUnseen(1.0, 10.0), (False, False)),
        (OnUnseen(9.5, -1.0), (False, True)),
        (OnUnseen(1.0, 0.0), (False, True)),
    ):
        page = reported(found, prepared, named, Tried(far, 5.0, unseen))
        (one,) = (o for o in page if "bias" in o.words)
        assert (better in one.remark, useless in one.remark) == remarked
    wild = replace(far, z=np.array([6.0]))
    (one,) = (
        o
        for o in reported(found, prepared, Tried(wild, 5.0, OnUnseen(np.nan, 0.0)))
        if "bias" in o.words
    )
    assert "sensor bias would need an unlikely value" in one.remark
    assert one.gap_unseen_channels is None


def test_without_causes_only_what_is_not_likely_is_not_named(
    noisy: Problem, prepared: PreparedRecord, sunk: Hypothesis
) -> None:
    nothing = found_with(noisy, [])
    tried = fitted(nothing, sunk)
    page = reported(nothing, prepared, Tried(tried, 1.0, SOME))
    (one,) = (o for o in page if "settlement" in o.words)
    assert one.remark.startswith("rejected: not likelier than no effect")
    sure = replace(tried, log_evidence=40.0)
    (one,) = (o for o in reported(nothing, prepared, Tried(sure, 1.0, SOME)) if "settle" in o.words)
    assert one.remark.startswith("likelier than no effect (+40 log-odds), and rejected")
