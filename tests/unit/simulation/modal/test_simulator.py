"""What frequency and mode_shape sensors read, and models that state them."""

import json
from typing import Any

import numpy as np
import pytest

import rga
from rga.model import Model, read_model
from rga.model.io import model_content, model_text
from rga.simulation.modal.simulator import ModalSimulator

SPAN, PARTS = 20.0, 8


def beam(**more: Any) -> dict[str, Any]:
    """A beam between two supports that bends up and down, and sideways on springs."""
    build = rga.ModelBuilder("footbridge").add_material("steel", E=210e9, density=7850)
    build.add_section("box", A=0.02, Iy=4e-4, Iz=6e-4, J=5e-4)
    for at in range(PARTS + 1):
        build.add_node(f"n{at}", SPAN * at / PARTS)
        if at:
            build.add_member(f"n{at - 1}", f"n{at}", "box", kind="frame", groups="deck")
    build.support("n0", "ux", "uz", "rx").support(f"n{PARTS}", "uz", "rx")
    for end in ("n0", f"n{PARTS}"):
        build.spring(end, "uy", 5e6)
    build.context("cold", "-", (0.0, 1.0))
    build.effect("bearings", "support_spring", **SOFTER)
    content = model_content(build.build())
    points = {
        f"{way}{at}": {"node": f"n{at}", "direction": direction}
        for at in range(PARTS + 1)
        for way, direction in (("V", [0, 0, 2]), ("L", [0, 1, 0]))
    }
    content |= {"points": points} | more
    return content


#: the springs of the bearings are three times as stiff when it is cold
SOFTER = {"support": "n0", "dof": "uy", "stiffness": {"context": "cold", "times": 4e7}}


def shape(way: str, half_waves: int) -> dict[str, float]:
    return {f"{way}{at}": float(np.sin(half_waves * np.pi * at / PARTS)) for at in range(PARTS + 1)}


MODES = {
    "vertical": {"near": 3.0, "shape": shape("V", 1)},
    "lateral": {"near": 3.2, "within": 0.3, "shape": shape("L", 1)},
}
SENSORS = {
    "f_v": {"kind": "frequency", "mode": "vertical", "unit": "Hz"},
    "f_l": {"kind": "frequency", "mode": "lateral", "unit": "Hz"},
    "end": {"kind": "mode_shape", "mode": "lateral", "point": "L0", "unit": "-"},
    "middle": {"kind": "mode_shape", "mode": "lateral", "point": "L4", "unit": "-"},
}


@pytest.fixture
def model() -> Model:
    return read_model(beam(modes=MODES, sensors=SENSORS), "a test")


def test_sensors_of_both_sorts_stand_together_in_the_file(model: Model) -> None:
    assert list(model.modal_sensors) == list(SENSORS)
    assert model.sensors == {}
    content = json.loads(model_text(model))
    assert list(content["sensors"]) == list(SENSORS)
    assert "modal_sensors" not in content
    assert read_model(content, "again").modal_sensors == model.modal_sensors


def test_bearings_that_stiffen_raise_the_lateral_frequency_alone(model: Model) -> None:
    warm, cold = ModalSimulator(model).predict({"cold": [0.0, 1.0]})
    assert warm[0] == pytest.approx(cold[0], rel=1e-9)
    assert cold[1] > 1.02 * warm[1]
    # What a stiff bearing holds moves less beside the middle.
    assert abs(cold[2] / cold[3]) < 0.7 * abs(warm[2] / warm[3])


def test_the_mode_of_a_number_is_known_by_its_shape_from_then_on() -> None:
    named = {"first": {"near": 3.0, "computed": 1}, "second": {"near": 3.0, "computed": 2}}
    sensors = {
        "f1": {"kind": "frequency", "mode": "first", "unit": "Hz"},
        "f2": {"kind": "frequency", "mode": "second", "unit": "Hz"},
        "m": {"kind": "mode_shape", "mode": "second", "point": "V4", "unit": "-"},
    }
    model = read_model(beam(modes=named, sensors=sensors), "a test")
    by_number = rga.modes(model, 2, {"cold": 0.5}).frequencies
    found = ModalSimulator(model).predict({"cold": [0.5]})
    np.testing.assert_allclose(found[0, :2], by_number, rtol=1e-9)


def test_a_model_that_is_extended_keeps_the_shapes_of_modes_known_by_their_number() -> None:
    named = {"first": {"near": 3.0, "computed": 1}, "second": {"near": 3.0, "computed": 2}}
    simulator = ModalSimulator(read_model(beam(modes=named), "a test"))
    known = simulator.with_shapes()
    assert [one.computed for one in known.modes.values()] == [None, None]
    again = read_model(json.loads(model_text(known)), "again")
    for name, look in ModalSimulator(again).expected.items():
        np.testing.assert_allclose(look.shape, simulator.expected[name].shape, rtol=1e-12)
    given = read_model(beam(modes=MODES, sensors=SENSORS), "a test")
    assert ModalSimulator(given).with_shapes() == given


@pytest.mark.parametrize("way", "VL")
def test_a_mode_that_moves_no_point_has_no_shape_of_round_off(way: str) -> None:
    """The lowest mode alone at the points: what it leaves of rounding has nothing beside it."""
    content = beam()
    content["points"] = {name: one for name, one in content["points"].items() if name[0] == way}
    content["modes"] = {"lowest": {"near": 3.0, "computed": 1}}
    simulator = ModalSimulator(read_model(content, "a test"))
    lowest = rga.modes(simulator.model, 1, {"cold": 0.5})
    along = {"V": "z", "L": "y"}[way]
    unseen = lowest.to_frame()["most along"][0] != along
    assert simulator.expected["lowest"].unseen is unseen


def test_rows_that_share_a_structure_read_the_same(model: Model) -> None:
    found = ModalSimulator(model).predict({"cold": [0.2, 0.8, 0.2]})
    assert found.shape == (3, 4)
    assert found[0].tobytes() == found[2].tobytes()


def test_pairing_says_how_much_alike_the_shapes_are(model: Model) -> None:
    pairing, frequencies, _ = ModalSimulator(model).pair({"cold": 0.0})
    mac = [pairing.mac[k, j] for k, j in enumerate(pairing.computed)]
    assert min(mac) > 0.8
    assert (np.diff(frequencies) >= 0).all()


@pytest.mark.parametrize(
    ("part", "name", "key", "value", "told"),
    [
        ("sensors", "f_v", "mode", "torsion", "there is no 'torsion' in modes"),
        ("sensors", "f_v", "unit", "kHz", "use Hz"),
        ("sensors", "f_v", "point", "V1", "a frequency has no 'point'"),
        ("sensors", "end", "point", "V0", "mode 'lateral' has no motion at point 'V0'"),
        ("sensors", "end", "point", "Z", "there is no 'Z' in points"),
        ("sensors", "end", "unit", "mm", "use -"),
        ("points", "V0", "node", "n99", "there is no 'n99' in nodes"),
        ("points", "V0", "direction", [0, 0, 0], "points nowhere"),
        ("modes", "vertical", "near", -1.0, "greater than 0"),
        ("modes", "vertical", "shape", {"Z": 1.0}, "there is no 'Z' in points"),
        ("modes", "vertical", "shape", {"V0": 0.0}, "zero at every point"),
        ("modes", "vertical", "computed", 2, "give one of the two"),
        ("modes", "vertical", "cluster", ["torsion"], "there is no 'torsion' in modes"),
    ],
)
def test_what_names_nothing_is_refused(
    part: str, name: str, key: str, value: object, told: str
) -> None:
    content = json.loads(json.dumps(beam(modes=MODES, sensors=SENSORS)))
    content[part][name][key] = value
    with pytest.raises(rga.InputError) as refused:
        read_model(content, "a test")
    assert told in str(refused.value)
    assert f"{part}.{name}" in str(refused.value)
    assert "modal_sensors" not in str(refused.value)


def test_a_model_that_expects_no_mode_is_none() -> None:
    with pytest.raises(rga.InputError, match="no mode is expected"):
        ModalSimulator(read_model(beam(), "a test"))


def test_large_displacements_leave_no_frequency() -> None:
    content = beam(modes=MODES, sensors=SENSORS, analysis={"geometry": "nonlinear"})
    with pytest.raises(rga.InputError, match="no natural frequency that is the same"):
        ModalSimulator(read_model(content, "a test")).predict({"cold": 0.0})
