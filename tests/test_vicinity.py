"""Effects tried about a simulation give what a simulator with these effects gives."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pytest

from rga.diagnosis.hypothesis import hypotheses
from rga.model import Model, read_effect, read_model
from rga.model.effect import Effect
from rga.simulation import Simulator
from rga.simulation.vicinity import Vicinity

ROWS = 40
#: tried of every kind
PLACES = 5
TIME = 3600.0 * np.arange(ROWS)


def contexts(model: Model) -> dict[str, Any]:
    draw = np.random.default_rng(5)
    drawn = {name: draw.uniform(*one.range, ROWS) for name, one in model.context.items()}
    return {"time": TIME, **drawn}


def models(content: dict[str, Any]) -> Iterator[Model]:
    """The bridge, and the same with effects of many kinds on it."""
    model = read_model(content, "small bridge")
    yield model
    found: dict[str, dict[str, Any]] = {
        "stiff": {
            "kind": "joint_rigidity",
            "group": ["verticals", "bottom chord"],
            "stiffness": 1e6,
        },
        "soft": {"kind": "support_flexibility", "support": "east", "dof": "uz", "stiffness": 1e7},
        "sinks": {
            "kind": "support_settlement",
            "support": "east",
            "dof": "uz",
            "displacement": 0.002,
        },
        "bias": {"kind": "context_bias", "context": "west load", "offset": 3.0},
        "late": {"kind": "thermal_lag", "time_constant": 3.0},
        "gain": {"kind": "sensor_gain", "sensor": "D2", "factor": 0.9},
    }
    yield model.extended({name: read_effect(one, name) for name, one in found.items()})
    loss = {"kind": "member_stiffness", "member": "L1-L2", "factor": 0.7, "onset": TIME[15]}
    yield model.extended({"loss": read_effect(loss, "loss")})


@pytest.fixture(scope="module", params=range(3))
def about(request: pytest.FixtureRequest, small_bridge: dict[str, Any]) -> Vicinity:
    sections = {"bar": {"A": 0.004, "Iy": 8e-6, "Iz": 5e-6, "J": 1e-7}}
    content = {**small_bridge, "sections": sections}
    model = list(models(content))[request.param]
    return Vicinity(Simulator(model), contexts(model))


def trials(model: Model) -> Iterator[Effect]:
    """Candidates of every kind at trial values, some of them from an onset on."""
    taken: dict[str, int] = {}
    for one in hypotheses(model, list(model.sensors), set(model.context)):
        taken[one.name] = taken.get(one.name, 0) + 1
        if taken[one.name] <= PLACES:
            chosen = list(product(*(prior.trials for prior in one.priors.values())))
            yield from (one.effect(z) for z in chosen)
            yield one.beginning(float(TIME[22])).effect(chosen[0])


def test_every_trial_reads_as_its_own_simulator(about: Vicinity) -> None:
    model = about.simulator.model
    scale = np.abs(about.response.quantities).max(0)
    seen = set()
    for effect in trials(model):
        trial, response = about.trial({"trial": effect})
        apart = np.abs(trial.read(response) - trial.predict(contexts(model))).max(0)
        assert (apart < 1e-9 * scale).all(), effect
        seen.add(effect.kind)
    assert len(seen) >= 20


def with_area(model: Model, name: str, factor: float) -> Model:
    """The model with the area of one member changed."""
    member = model.members[name]
    section = model.sections[member.section]
    sections = {"other": section.model_copy(update={"A": section.A * factor})}
    members = {name: member.model_copy(update={"section": "other"})}
    changes = {
        "sections": {**model.sections, **sections},
        "members": {**model.members, **members},
    }
    return model.model_copy(update=changes)


def test_stiffness_rates_are_the_derivatives(about: Vicinity) -> None:
    model, step = about.simulator.model, 1e-4
    rates = about.stiffness_rates()
    scale = np.abs(about.response.quantities).max(0)
    assert len(rates) >= 6
    names = list(model.members)
    for member, rate in rates.items():
        sides = []
        for sign in (1, -1):
            thicker = with_area(model, names[member], float(np.exp(sign * step)))
            sides.append(Simulator(thicker).respond(contexts(model)).quantities)
        expected = (sides[0] - sides[1]) / (2 * step)
        assert (np.abs(rate - expected).max(0) < 1e-7 * scale).all()
