"""Bearings that a model has as springs: stiffer by one beside, softer by one behind."""

from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model, read_model
from rga.model.effect import Effect
from rga.simulation import Simulator

SPRING = 2e7


def beam(spring: float, **effect: Any) -> Model:
    """A bar on a spring that is pulled along itself."""
    return read_model(
        {
            "rga_model": 1,
            "name": "a bar on a spring",
            "plane": "xz",
            "materials": {"steel": {"E": 2e11}},
            "sections": {"bar": {"A": 0.01}},
            "nodes": {"A": [0, 0, 0], "B": [2, 0, 0]},
            "members": {"A-B": {"nodes": ["A", "B"], "section": "bar", "material": "steel"}},
            "supports": {
                "west": {"node": "A", "fixed": ["uz"]}, "east": {"node": "B", "fixed": ["uz"]}
            },
            "springs": [{"node": "A", "dof": "ux", "stiffness": spring}],
            "sensors": {
                "D": {"kind": "displacement", "unit": "mm", "node": "B", "direction": [1, 0, 0]}
            },
            "effects": {
                "load": {"kind": "nodal_load", "forces": {"B": [1e4, 0, 0]}},
                **({"bearing": effect} if effect else {}),
            },
        },
        "a test",
    )  # fmt: skip


def moved(model: Model) -> float:
    return float(Simulator(model).predict({})[0, 0])


@pytest.mark.parametrize("node", ["A", ["A"]])
@pytest.mark.parametrize(
    ("kind", "stiffness", "together"),
    [
        ("support_spring", 4e7, SPRING + 4e7),
        ("support_spring", 0.0, SPRING),
        ("support_flexibility", 4e7, 1.0 / (1.0 / SPRING + 1.0 / 4e7)),
    ],
)
def test_a_spring_of_the_model_is_stiffer_or_softer(
    kind: str, stiffness: float, together: float, node: str | list[str]
) -> None:
    with_effect = beam(SPRING, kind=kind, node=node, dof="ux", stiffness=stiffness)
    np.testing.assert_allclose(moved(with_effect), moved(beam(together)), rtol=1e-9)


@pytest.mark.parametrize("kind", ["support_spring", "support_flexibility"])
def test_both_are_proposed_at_it_about_its_own_size(kind: str) -> None:
    model = beam(SPRING)
    own = Effect.vocabulary[kind]
    (place,) = [one for one in own.places(model) if "node" in one]
    assert place == {"node": "A", "dof": "ux"}
    assert own.priors(model, place)["stiffness"].value(0.0) == SPRING


@pytest.mark.parametrize("kind", ["support_spring", "support_flexibility"])
@pytest.mark.parametrize(
    ("place", "said"),
    [
        ({}, "needs one place: give 'support' or 'node'"),
        ({"node": "A", "support": "west"}, "needs one place: give 'support' or 'node'"),
        ({"node": "B"}, "no spring to the ground holds node 'B' in ux"),
    ],
)
def test_where_there_is_no_spring_it_is_refused(kind: str, place: Any, said: str) -> None:
    with pytest.raises(InputError) as refused:
        beam(SPRING, kind=kind, dof="ux", stiffness=1e7, **place)
    assert said in str(refused.value)
