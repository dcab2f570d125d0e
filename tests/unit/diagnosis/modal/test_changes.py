"""A cause that leaves the modes as they were is told, and one that moves them is not."""

from dataclasses import replace

import numpy as np
import pytest

from independent.modal_bridge import Hidden, measured
from rga.diagnosis.modal.candidates import modal_hypotheses
from rga.diagnosis.modal.changes import moving_nothing, passing
from rga.diagnosis.modal.fit import ModalFit, fitted, predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials


def fit_at(factor: float, onset: float | None = None) -> tuple[ModalLikelihood, ModalFit]:
    """A factor on the bottom bracing, wherever the data would put it."""
    model, record = measured(0, Hidden(), windows=10)
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    (bracing,) = (
        one
        for one in modal_hypotheses(likelihood.trials)
        if (one.name, one.place.get("group")) == ("member_stiffness", "bottom bracing")
    )
    if onset is not None:
        bracing = bracing.beginning(onset)
    fit = fitted(likelihood, [bracing], [0.0])
    (prior,) = bracing.priors.values()
    z = np.array([prior.z(factor)])
    return likelihood, replace(fit, z=z, prediction=predicted(likelihood, [bracing], z))


@pytest.mark.parametrize(("factor", "moves"), [(0.999, False), (0.5, True)])
def test_a_cause_that_moves_no_mode_is_told(factor: float, moves: bool) -> None:
    told = moving_nothing(*fit_at(factor))
    assert [
        one.startswith("member stiffness, bottom bracing moves no frequency by more than 0.")
        for one in told
    ] == [True] * (not moves)


def test_a_change_within_the_record_is_held_against_what_was_before_it() -> None:
    assert moving_nothing(*fit_at(0.999, onset=18_000.0)) == []


@pytest.mark.parametrize(("again", "told"), [(1.0, True), (0.7, False)])
def test_what_comes_and_goes_may_be_one_thing(again: float, told: bool) -> None:
    """A bracing that is softer from a window on, and from another as it was, or hardly better."""
    model, record = measured(0, Hidden(), windows=12)
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    stiffness = {
        str(one.place["group"]): one
        for one in modal_hypotheses(likelihood.trials)
        if one.name == "member_stiffness" and "group" in one.place
    }
    softer = stiffness["bottom bracing"].beginning(4 * 3600.0)
    back = stiffness["bottom bracing"].beginning(8 * 3600.0)
    fit = fitted(likelihood, [softer, back], [0.0, 0.0])
    priors = [next(iter(one.priors.values())) for one in (softer, back)]
    factors = (0.5, again / 0.5)
    z = np.array([prior.z(factor) for prior, factor in zip(priors, factors, strict=True)])
    fit = replace(fit, z=z, prediction=predicted(likelihood, [softer, back], z))
    words = passing(likelihood, fit)
    assert [one.startswith("from 28800.0 on the modes are again") for one in words] == [True] * told
