"""Effects tried about a simulation give what a simulator with these effects gives."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pytest

from rga.diagnosis.search.hypothesis import hypotheses
from rga.model import Model, read_effect, read_model
from rga.model.effect import Effect
from rga.simulation import Simulator
from rga.simulation.perturbation.trials import Vicinity

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


@pytest.fixture(params=["slips", "rubs", "wears"])
def dear(request: pytest.FixtureRequest, small_bridge: dict[str, Any]) -> Vicinity:
    """A simulation about which every trial takes other solves: corners, memory, or many states."""
    found = {
        "slips": {"kind": "joint_slip", "member": "L1-L2", "slip": 1e-6},
        "rubs": {"kind": "bearing_friction", "support": "east", "dof": "ux", "mu": 0.02},
        "wears": {
            "kind": "member_stiffness",
            "member": "L1-L2",
            "factor": 0.6,
            "onset": TIME[2],
            "profile": "ramp",
        },
    }[request.param]
    model = read_model(small_bridge, "small bridge")
    model = model.extended({"dear": read_effect(found, "dear")})
    return Vicinity(Simulator(model), contexts(model))


def test_a_dear_simulation_is_tried_nearly(dear: Vicinity) -> None:
    # Friction begins anew where a structure changes, so that a late loss has another history there.
    rubs = "bearing_friction" in [one.kind for one in dear.simulator.model.effects.values()]
    gain = read_effect({"kind": "sensor_gain", "sensor": "D2", "factor": 1.1}, "gain")
    for onset in (None,) if rubs else (None, TIME[20]):
        loss = {"kind": "member_stiffness", "member": "L1-U1", "factor": 0.9, "onset": onset}
        effects = {"gain": gain, "loss": read_effect(loss, "loss")}
        nearly, exact = dear.nearly(effects)
        trial, response = dear.trial(effects)
        change = trial.read(response) - dear.read
        assert not exact
        assert (np.abs(nearly - dear.read - change) <= 1e-9 + 0.1 * np.abs(change).max(0)).all()
        assert np.abs(change).max(0)[[0, 1]].min() > 0


def test_what_is_not_dear_is_tried_exactly(about: Vicinity) -> None:
    for effect in list(trials(about.simulator.model))[::7]:
        nearly, exact = about.nearly({"trial": effect})
        trial, response = about.trial({"trial": effect})
        if exact:
            assert np.array_equal(nearly, trial.read(response))
        else:
            assert effect.kind in ("bearing_friction", "stiffness_temperature")
