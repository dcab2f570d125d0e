"""Structures along a line of parameters: interpolated responses against structures solved anew."""

import numpy as np
import pytest

from rga.benchmark.truth import draw_case
from rga.model import read_effect, read_model
from rga.simulation import Simulator
from rga.simulation.along_line import MOST, between, positions


@pytest.mark.parametrize("rate", [-4e-3, 8e-3])
def test_a_stiff_truss_that_softens_with_warmth(rate: float) -> None:
    case = draw_case(5, bridge="pratt", kind="null", rows=90)
    stiff = {"kind": "joint_rigidity", "group": ["lower chord", "upper chord"], "stiffness": 7e7}
    warm = {"kind": "stiffness_temperature", "group": "lower chord", "rate": rate}
    effects = {"stiff": read_effect(stiff, "stiff"), "warm": read_effect(warm, "warm")}
    model = read_model(case.model, "case").extended(effects)
    contexts = {name: np.nan_to_num(case.channels[name]) for name in model.context}
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
    assert positions(line[:MOST]) is None


def test_what_no_few_points_follow_is_told() -> None:
    ends = np.zeros(1), np.ones(1)
    smooth = between(*ends, lambda state: np.array([[1.0 / (1.2 + state[0])]]))
    assert smooth is not None
    assert smooth(np.array([0.3]))[0, 0, 0] == pytest.approx(1 / 1.5, rel=1e-11)
    assert between(*ends, lambda state: np.array([[abs(state[0] - 0.4)]])) is None
