"""The one measurement that would separate a cause from its rival, in words."""

from dataclasses import replace

import numpy as np
import pytest

from planned_bridge import GAIN, SOFT, explained
from rga.diagnosis.advice import NOTHING, Advice
from rga.diagnosis.search.linearised import Problem
from rga.experiments.explanation import CandidateModel
from rga.model import Model, read_effect


@pytest.fixture
def soft(model: Model) -> CandidateModel:
    return explained(model, SOFT, factor=(0.6, 0.03))


def advice(model: Model, posed: Problem, together: CandidateModel) -> Advice:
    return Advice(model, replace(posed, levels=np.array([0.025, 0.01, 0.003])), together)


def test_a_measurement_that_separates_is_named(
    model: Model, posed: Problem, soft: CandidateModel
) -> None:
    """A soft bar strains more than one beside a gauge that reads too much."""
    words = advice(model, posed, soft).against(explained(model, GAIN, factor=(1.67, 0.05)))
    assert "tells them apart (d_perp" in words
    assert words.startswith(("measuring the ", "a load test, "))


def test_an_explanation_beside_itself_cannot_be_separated(
    model: Model, posed: Problem, soft: CandidateModel
) -> None:
    words = advice(model, posed, soft).against(soft)
    assert words == NOTHING


def test_what_no_single_measurement_separates_is_said_with_the_best(
    model: Model, posed: Problem
) -> None:
    sure = explained(model, SOFT, factor=(0.97, 0.001))
    unsure = explained(model, GAIN, factor=(1.03, 0.03))
    words = advice(model, posed, sure).against(unsure)
    assert words.startswith(("no single added sensor", NOTHING))
    assert "tells them apart" not in words


def test_a_rival_that_cannot_be_simulated_leaves_no_advice(
    model: Model, posed: Problem, soft: CandidateModel
) -> None:
    lost = read_effect({**SOFT, "factor": 0.0}, "test")
    broken = CandidateModel("a bar that is gone", {"gone": lost}, ())
    assert advice(model, posed, soft).against(broken) == ""
