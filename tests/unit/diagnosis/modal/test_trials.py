"""What a model says of itself holds window by window as hypotheses do."""

import numpy as np
import pytest

from independent.modal_bridge import Hidden, bridge, measured
from rga.diagnosis.modal.readings import ModalReadings, ModalWindows
from rga.diagnosis.modal.trials import ModalTrials
from rga.model import read_effect, read_model
from rga.model.effect import Effect
from rga.model.effects.masses.added_mass import AddedMass
from rga.model.effects.members.elastic_modulus import ElasticModulus
from rga.model.effects.sensors.clock_rate import ClockRate
from rga.model.parameter import Estimated
from rga.simulation.modal.expected import Expected

WINDOWS = 12
MODEL, RECORD = measured(3, Hidden(), modes=4, windows=WINDOWS)
READINGS = ModalReadings.of(MODEL, RECORD)
MIDDLE = float(READINGS.time[WINDOWS // 2])
GROUP = next(iter(MODEL.groups))


@pytest.mark.parametrize(
    "effect",
    [
        ClockRate(factor=1.01),
        ClockRate(factor=Estimated(value=1.01, ci90=(1.0, 1.02)), onset=MIDDLE),
        AddedMass(group=GROUP, per_length=200.0, onset=MIDDLE),
        AddedMass(
            group=GROUP,
            per_length=Estimated(value=200.0, ci90=(1.0, 400.0)),
            onset=float(READINGS.time[0]),
            profile="ramp",
        ),
        ElasticModulus(material="steel", factor=0.9, onset=MIDDLE),
        ElasticModulus(material="steel", factor=0.9),
    ],
)
def test_an_effect_of_the_model_is_as_one_that_is_tried(effect: Effect) -> None:
    tried = ModalTrials(MODEL, READINGS).predict({"more": effect})
    stated = ModalTrials(MODEL.extended({"more": effect}), READINGS).predict({})
    np.testing.assert_allclose(stated.log_f, tried.log_f, rtol=0, atol=1e-9)
    np.testing.assert_allclose(np.abs(stated.shapes), np.abs(tried.shapes), rtol=1e-6, atol=1e-9)
    without = ModalTrials(MODEL, READINGS).predict({})
    assert np.abs(stated.log_f - without.log_f).max() > 1e-3


def test_beside_a_parked_truck_members_that_soften_ask_for_their_temperature() -> None:
    content = bridge()
    content["context"] = {
        "truck": {"unit": "-", "range": [0, 1]},
        "air": {"unit": "degC", "range": [-20, 40]},
    }
    content["effects"] = {
        "truck": {
            "kind": "nodal_load", "forces": {"b3n": [0, 0, -20e3]},
            "factor": {"context": "truck"}, "inertia": True,
        },
        "warm": {
            "kind": "temperature", "groups": {"top n": 1.0},
            "delta": {"context": "air", "minus": 10.0},
        },
    }  # fmt: skip
    model = read_model({**content, "modes": {"m": {"near": 5.0, "computed": 1}}}, "bridge")
    windows = ModalWindows(
        modes=("m",),
        time=np.zeros(2),
        contexts={"truck": np.array([0.0, 1.0]), "air": np.array([30.0, 30.0])},
        log_f=np.log(np.full((2, 1), 5.0)),
        looks=(Expected(5.0, 0.5, np.zeros(0, dtype=np.int64), np.zeros(0)),),
    )
    softer = {"kind": "stiffness_temperature", "group": "top n", "rate": -5e-3}
    trials = ModalTrials(model, windows)
    moved = trials.predict({"softer": read_effect(softer, "softer")}).log_f
    assert (moved < trials.predict({}).log_f).all()
