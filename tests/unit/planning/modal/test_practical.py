"""A mass that nobody has, or that makes another structure, is told."""

import pytest

from independent.modal_bridge import bridge
from rga.experiments.truck import Truck
from rga.model import Model, read_model
from rga.model.mass_budget import mass_budget
from rga.planning.modal.practical import FULL, LARGE, TRUCKS, impractical

GRAVITY = 9.80665


@pytest.fixture(scope="module")
def model() -> Model:
    return read_model(bridge(), "bridge")


@pytest.fixture(scope="module")
def whole(model: Model) -> float:
    """What the structure weighs [t]."""
    return sum(part.total for part in mass_budget(model)) / 1e3


def weights(mass: float) -> Truck:
    """Two that are so heavy together [t]."""
    return Truck((mass * GRAVITY / 2,) * 2, (2.0,))


def test_what_is_a_small_share_is_planned_without_a_word(model: Model, whole: float) -> None:
    assert impractical(model, weights(0.99 * LARGE * whole), given=False) is None


def test_a_large_share_of_the_structure_is_told_whoever_has_it(model: Model, whole: float) -> None:
    for given in (False, True):
        words = impractical(model, weights(0.3 * whole), given)
        assert words is not None
        assert f"0.3 of the {whole:.3g} t that the structure weighs" in words
        assert "--truck" in words
        assert "full trucks" not in words


def test_more_trucks_than_can_be_had_are_told_unless_they_are_there(model: Model) -> None:
    content = bridge()
    for mass in content["masses"].values():
        mass["mass"] *= 1000.0
    heavy = read_model(content, "heavy bridge")
    assert impractical(heavy, weights(0.99 * TRUCKS * FULL), given=False) is None
    words = impractical(heavy, weights(640.0), given=False)
    assert words is not None
    assert "as much as 16 full trucks" in words
    assert impractical(heavy, weights(640.0), given=True) is None
