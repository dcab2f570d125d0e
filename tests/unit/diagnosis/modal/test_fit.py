"""Ends of intervals lie where the loss has risen, whatever slopes say there."""

from dataclasses import replace

import numpy as np
import pytest

from independent.modal_bridge import Hidden, measured
from rga.diagnosis.modal.candidates import modal_hypotheses
from rga.diagnosis.modal.fit import RISE, ModalFit, fitted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials


@pytest.fixture(scope="module")
def fit() -> ModalFit:
    """A mass on a node, of which modes tell well."""
    model, record = measured(0, Hidden(mass={"b3n": 2000.0}))
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    (mass,) = [
        one
        for one in modal_hypotheses(likelihood.trials)
        if (one.name, one.place.get("node"), one.onset) == ("added_mass", "b3n", None)
    ]
    return fitted(likelihood, [mass], [1.0])


def test_ends_are_those_of_the_slopes_where_these_hold(fit: ModalFit) -> None:
    spread = fit.information[0, 0] ** -0.5
    assert fit.interval[0] == pytest.approx(fit.z[0] + 1.645 * spread * np.array([-1, 1]), rel=0.1)


def test_steep_slopes_at_a_jump_do_not_narrow_it(fit: ModalFit) -> None:
    steep = replace(fit, signatures=30.0 * fit.signatures)
    low, high = steep.interval[0]
    assert (low, high) == pytest.approx(fit.interval[0], rel=0.1)
    for end in (low, high):
        assert steep._rise(np.array([end]) - fit.z) == pytest.approx(RISE, rel=0.3)
