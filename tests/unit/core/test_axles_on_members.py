"""Axles that frame members carry between their nodes, beside the closed forms of a beam."""

from typing import Any

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model, read_model
from rga.model.io import model_content
from rga.simulation import Simulator, results

LENGTH, E, BENDS, HALF_DEPTH, AXLE = 12.0, 2e11, 1e-4, 0.1, 1e5
PLACE = np.linspace(0.0, LENGTH, 241)


def beam(parts: int, carried_by: str | None, turned: bool = False, kind: str = "frame") -> Model:
    """A simply supported beam under an axle, its members drawn from either side."""
    names = [f"n{k}" for k in range(parts + 1)]
    ends = [names[k : k + 2] for k in range(parts)]
    middle: dict[str, Any] = {"member": f"m{parts // 2}", "at": 0.5 if parts % 2 else 0.0}
    if turned:
        ends, middle["at"] = [pair[::-1] for pair in ends], 1.0 - middle["at"]
    content = {
        "rga_model": 1,
        "name": "beam",
        "plane": "xz",
        "materials": {"steel": {"E": E}},
        "sections": {"girder": {"A": 0.01, "Iy": BENDS, "Iz": BENDS, "J": 1e-6}},
        "nodes": {name: [LENGTH * k / parts, 0, 0] for k, name in enumerate(names)},
        "members": {
            f"m{k}": {"nodes": pair, "section": "girder", "material": "steel", "kind": kind}
            for k, pair in enumerate(ends)
        },
        "supports": {
            "west": {"node": names[0], "fixed": ["ux", "uz"]},
            "east": {"node": names[-1], "fixed": ["uz"]},
        },
        "context": {"place": {"unit": "m", "range": [0, LENGTH]}},
        "effects": {
            "axle": {
                "kind": "axle_load",
                "path": names,
                "forces": [AXLE],
                "offsets": [0.0],
                "position": {"context": "place"},
                "carried_by": carried_by,
            }
        },
        "sensors": {
            "tilt": {"kind": "rotation", "node": "n0", "direction": [0, 1, 0], "unit": "rad"},
            "gauge": {"kind": "strain", **middle, "z": -HALF_DEPTH, "unit": "m/m"},
        },
    }
    return read_model(content, "beam")


def closed_form() -> FloatArray:
    """Rotation of the west end about +y and strain at mid-span, float[places, 2]."""
    away, near = LENGTH - PLACE, np.minimum(PLACE, LENGTH - PLACE)
    tilt = AXLE * PLACE * away * (LENGTH + away) / (6 * LENGTH * E * BENDS)
    return np.column_stack([tilt, AXLE * near / 2 * HALF_DEPTH / (E * BENDS)])


def off(model: Model) -> FloatArray:
    """Worst error of each sensor over its largest reading, float[2]."""
    exact = closed_form()
    read = Simulator(model).predict({"time": np.arange(len(PLACE)), "place": PLACE})
    return np.asarray(np.abs(read - exact).max(0) / np.abs(exact).max(0))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("parts", "most"), [(1, 2e-4), (2, 2e-4), (3, 2e-4), (8, 2e-4)])
def test_a_member_bends_under_the_axle_that_it_carries(
    parts: int, most: float, turned: bool
) -> None:
    for carried_by in ("members", None):
        tilt, gauge = off(beam(parts, carried_by, turned))
        assert tilt < most
        assert gauge < 1e-9  # the peak stands on a place that takes load


def test_nodes_that_carry_it_leave_the_members_straight() -> None:
    tilt, gauge = off(beam(3, "nodes"))
    assert tilt > 0.1
    assert gauge > 0.1


def test_nothing_but_frame_members_can_carry_it() -> None:
    with pytest.raises(InputError, match="no frame member joins 'n0' and 'n1'"):
        beam(2, "members", kind="truss")


def test_bars_leave_it_to_their_nodes() -> None:
    """What an effect makes of a joint moves no load, and a frame on the path carries its own."""
    joints = {"kind": "joint_rigidity", "group": "chord", "stiffness": 1e3}
    place = {"time": np.arange(3.0), "place": np.array([1.0, 4.5, 7.5])}
    content = model_content(beam(4, None, kind="truss"))
    for number, member in enumerate(content["members"].values()):
        member |= {"groups": ["chord"]} if number < 3 else {"kind": "frame"}
    content["supports"] |= {node: {"node": node, "fixed": ["uz"]} for node in ("n1", "n2", "n3")}
    content["sensors"] = {
        node: {"kind": "reaction", "node": node, "direction": [0, 0, 1], "unit": "N"}
        for node in content["nodes"]
    }
    plain = Simulator(read_model(content, "bars")).predict(place)
    np.testing.assert_allclose(plain[1], [0, AXLE / 2, AXLE / 2, 0, 0], atol=1e-6)
    content["effects"]["joints"] = joints
    np.testing.assert_allclose(
        Simulator(read_model(content, "bars")).predict(place)[1][0], 0, atol=1e-6
    )


@pytest.mark.parametrize("parts", [1, 3])
def test_results_are_exact_wherever_an_axle_stands(parts: int) -> None:
    place = np.array([1.234, 4.0, 7.77, 11.9])
    found = results(beam(parts, None), {"place": place, "time": np.arange(4.0)}, stations=601)
    x = np.concatenate([LENGTH / parts * (k + found.stations) for k in range(parts)])
    away = LENGTH - place[:, None]
    exact = -AXLE * np.minimum(x * away, place[:, None] * (LENGTH - x)) / LENGTH
    moments = found.section_forces[..., 4].reshape(4, -1)
    np.testing.assert_allclose(moments, exact, atol=1e-9 * np.abs(exact).max())
    tilt = AXLE * place * away[:, 0] * (LENGTH + away[:, 0]) / (6 * LENGTH * E * BENDS)
    np.testing.assert_allclose(found.displacements[:, 0, 4], tilt, rtol=1e-9)
