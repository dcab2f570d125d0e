"""Structures along a line of parameters: interpolated responses against structures solved anew."""

from typing import Any

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.model import read_effect, read_model
from rga.simulation import Simulator
from rga.simulation.perturbation.chebyshev import FEWEST, MOST, between, positions
from rga_bench.synthetic import draw_case

#: a bearing on a spring that settles, and one that gives way late
SPRING = {"kind": "support_flexibility", "support": "B1", "dof": "uz", "stiffness": 3e7}
SETTLED = {"kind": "support_settlement", "support": "B1", "dof": "uz", "displacement": -0.01}
LATE = {**SPRING, "onset": 40.0}


@pytest.mark.parametrize(
    ("rate", "beside"), [(-4e-3, []), (8e-3, []), (-4e-3, [SPRING, SETTLED]), (8e-3, [LATE])]
)
def test_a_stiff_truss_that_softens_with_warmth(rate: float, beside: list[dict[str, Any]]) -> None:
    case = draw_case(5, bridge="pratt", kind="null", rows=90)
    stiff = {"kind": "joint_rigidity", "group": ["lower chord", "upper chord"], "stiffness": 7e7}
    warm = {"kind": "stiffness_temperature", "group": "lower chord", "rate": rate}
    effects = {str(k): read_effect(one, str(k)) for k, one in enumerate([stiff, warm, *beside])}
    model = read_model(case.model, "case").extended(effects)
    contexts = {name: np.nan_to_num(case.channels[name]) for name in model.context}
    contexts["time"] = np.arange(90.0)
    whole = Simulator(model).predict(contexts)
    few = [
        Simulator(model).predict({name: column[k : k + 10] for name, column in contexts.items()})
        for k in range(0, 90, 10)
    ]
    anew = np.concatenate(few)
    assert Simulator(model).predict(contexts).tobytes() == whole.tobytes()
    assert np.abs(whole - anew).max() <= 1e-10 * np.abs(anew).max()
    assert (np.abs(whole - anew).max(0) <= 1e-9 * np.abs(anew).max(0)).all()


def test_only_parameters_on_a_line_are_interpolated() -> None:
    drawn = np.random.default_rng(1).uniform(1.0, 2.0, (2 * MOST, 2))
    assert positions(drawn) is None
    line = np.linspace(0.0, 1.0, 2 * MOST)[:, None]
    place = positions([3.0, 1.0] + line * [2.0, -0.5])
    assert place is not None
    assert np.allclose(place, line[:, 0])
    assert positions(line[:FEWEST]) is None
    rigid = np.full_like(line, np.inf)
    assert np.array_equal(positions(np.hstack([rigid, line])), positions(line))


def test_what_stays_rigid_stays_so_between() -> None:
    ends = np.array([np.inf, 0.0]), np.array([np.inf, 1.0])
    found = between(*ends, lambda state: np.array([[1.0 / (1.2 + state[1]) + 1.0 / state[0]]]))
    assert found is not None
    assert found(np.array([0.3]))[0, 0, 0] == pytest.approx(1 / 1.5, rel=1e-11)


def test_what_no_few_points_follow_is_reported() -> None:
    ends = np.zeros(1), np.ones(1)
    smooth = between(*ends, lambda state: np.array([[1.0 / (1.2 + state[0])]]))
    assert smooth is not None
    assert smooth(np.array([0.3]))[0, 0, 0] == pytest.approx(1 / 1.5, rel=1e-11)
    assert between(*ends, lambda state: np.array([[abs(state[0] - 0.4)]])) is None


def test_a_stop_that_grows_is_no_line(small_bridge: dict[str, Any]) -> None:
    time = np.arange(80.0)
    contexts = {"time": time, **{name: 40.0 * np.cos(time) for name in small_bridge["context"]}}
    stop = {"kind": "support_gap", "support": "east", "dof": "ux", "gap": 1e-5, "stiffness": 1e7}
    model = read_model(small_bridge, "small bridge")

    def shown(effect: dict[str, Any]) -> FloatArray:
        extended = model.extended({"stop": read_effect(effect, "stop")})
        return Simulator(extended).predict(contexts)

    grown = shown({**stop, "onset": 10.0, "profile": "ramp", "end": 60.0})
    assert np.allclose(grown[60:], shown(stop)[60:], rtol=1e-12)
    assert np.abs(grown[60:] - shown({**stop, "gap": 0.0})[60:]).max() > 1e-3
