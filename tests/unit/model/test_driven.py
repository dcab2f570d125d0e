"""Parameters that follow a context along two lines that meet."""

from typing import Any

import numpy as np
import pytest

import rga
from rga.errors import InputError
from rga.model import Model, read_model
from rga.model.io import model_content
from rga.model.parameter import Driven


def beam(effect: dict[str, Any]) -> Model:
    """A cantilever under a force of one newton, whose tip stands on a spring."""
    build = rga.ModelBuilder("beam").add_material("steel", E=210e9)
    build.add_section("bar", A=1e-2, Iy=1e-5, Iz=1e-5, J=1e-5)
    build.add_node("wall").add_node("tip", 3.0)
    build.add_member("wall", "tip", "bar", kind="frame", groups="all").support("wall", "fixed")
    build.context("air", "degC", (-30.0, 40.0))
    build.effect("push", "nodal_load", forces={"tip": [0.0, 0.0, -1.0]})
    build.sensor("sag", "displacement", unit="m", node="tip", direction=[0, 0, -1])
    content = model_content(build.build())
    content["supports"]["tip"] = {"node": "tip", "fixed": []}
    content["effects"]["more"] = effect
    return read_model(content, "a test")


def spring(stiffness: dict[str, Any]) -> dict[str, Any]:
    return {"kind": "support_spring", "support": "tip", "dof": "uz", "stiffness": stiffness}


FROST = {"context": "air", "kink": 0.0, "below": -5e4, "at": 1e5}


def test_soil_that_freezes_bears_more() -> None:
    model = beam(spring(FROST))
    air = np.array([-20.0, -10.0, 0.0, 30.0])
    sag = rga.Simulator(model).predict({"air": air})[:, 0]
    bending = 3 * 210e9 * 1e-5 / 3.0**3
    soil = 1e5 + 5e4 * np.array([20.0, 10.0, 0.0, 0.0])
    np.testing.assert_allclose(sag, 1.0 / (bending + soil), rtol=1e-9)


def test_left_out_it_does_nothing_at_the_kink() -> None:
    frost = {"context": "air", "kink": 4.0, "below": -0.01, "above": 0.02}
    model = beam({"kind": "elastic_modulus", "material": "steel", "factor": frost})
    sag = rga.Simulator(model).predict({"air": np.array([4.0, -6.0, 9.0])})[:, 0]
    np.testing.assert_allclose(sag[0] / sag, [1.0, 1.1, 1.1], rtol=1e-9)


def test_it_is_written_as_it_was_read() -> None:
    model = beam(spring(FROST))
    again = read_model(model_content(model), "again")
    assert again.effects["more"] == model.effects["more"]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"below": 1.0}, "give kink too"),
        ({"at": 1.0}, "give kink too"),
        ({"kink": 0.0, "times": 2.0}, "give below and above"),
        ({"kink": 0.0, "minus": 2.0}, "give below and above"),
        ({"kink": 0.0, "log10": True}, "give below and above"),
    ],
)
def test_half_a_kink_is_refused(given: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        beam(spring({"context": "air", **given}))


def test_where_nothing_is_neutral_the_kink_needs_a_value() -> None:
    soft = {"kind": "support_flexibility", "support": "wall", "dof": "uz"}
    with pytest.raises(InputError, match="stiffness: give 'at'"):
        beam({**soft, "stiffness": {"context": "air", "kink": 0.0, "below": -5e4}})


def test_a_factor_that_runs_away_is_refused() -> None:
    soft = {"kind": "elastic_modulus", "material": "steel"}
    with pytest.raises(InputError, match="changes by 10 with every unit of 'air': give below"):
        beam({**soft, "factor": {"context": "air", "kink": 0.0, "below": -10.0}})


def test_no_temperature_has_a_kink() -> None:
    warm = {"kind": "temperature", "groups": {"all": 1.0}, "delta": {"context": "air", "kink": 0.0}}
    with pytest.raises(InputError, match="linearly"):
        beam(warm)


def test_plain_ones_are_as_ever() -> None:
    plain = Driven(context="air", times=2.0, minus=5.0)
    np.testing.assert_array_equal(plain.follow(np.array([6.0]), neutral=1.0), [2.0])
