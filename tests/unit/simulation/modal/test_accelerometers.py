"""Accelerometers that are turned, exchanged or dead: what is read of shapes at their points."""

from typing import Any

import numpy as np
import pytest

from independent.modal_bridge import Hidden, described
from rga.errors import InputError
from rga.model import Effect, Model, read_model
from rga.model.io import model_content
from rga.simulation import ModalSimulator, Simulator

POINTS = ("b3n z", "t3n y", "b1s z")


def content(**effects: dict[str, Any]) -> dict[str, Any]:
    """The bridge with sensors of two shapes at three points, and a gauge."""
    found, _ = described(0, Hidden(), modes=2, windows=1)
    found["sensors"] |= {
        f"{mode} {point}": {"kind": "mode_shape", "mode": mode, "point": point, "unit": "-"}
        for mode in ("m0", "m1")
        for point in POINTS
    } | {"D1": {"kind": "displacement", "node": "b3n", "direction": [0, 0, 1], "unit": "mm"}}
    return found | {"effects": effects}


def bridge(**effects: dict[str, Any]) -> Model:
    return read_model(content(**effects), "bridge")


def read(time: tuple[float, ...] = (0.0,), **effects: dict[str, Any]) -> np.ndarray:
    """Frequencies, then shapes: float[rows, 2], float[rows, modes, points]."""
    shown = ModalSimulator(bridge(**effects)).predict({"time": np.array(time)})
    return np.asarray(shown[:, 2:].reshape(len(time), 2, len(POINTS)))


GAIN = {"kind": "sensor_gain", "point": POINTS[0], "factor": -1.0}
SWAP = {"kind": "sensor_swap", "points": [POINTS[0], POINTS[2]]}
DEAD = {"kind": "sensor_fault", "point": POINTS[1], "mode": "dead"}


def test_a_turned_one_reads_the_shapes_of_all_modes_the_other_way_round() -> None:
    (plain,), (turned,) = read(), read(own=GAIN)
    np.testing.assert_allclose(turned, plain * [-1.0, 1.0, 1.0], rtol=1e-12)
    (two,) = read(own=GAIN | {"point": [POINTS[0], POINTS[1]], "factor": 0.5})
    np.testing.assert_allclose(two, plain * [0.5, 0.5, 1.0], rtol=1e-12)


def test_two_are_exchanged_from_a_time_on() -> None:
    before, after = read((0.0, 20.0), own=SWAP | {"onset": 10.0})
    np.testing.assert_array_equal(after, before[:, [2, 1, 0]])
    assert not np.allclose(after, before)


def test_a_dead_one_reads_nothing() -> None:
    before, after = read((0.0, 20.0), own=DEAD | {"onset": 10.0})
    assert np.isnan(after).tolist() == [[False, True, False]] * 2
    assert np.isfinite(before).all()


def test_gauges_feel_nothing_of_it_and_frequencies_neither() -> None:
    several = {"gain": GAIN, "swap": SWAP, "dead": DEAD}
    plain, changed = (ModalSimulator(one).predict() for one in (bridge(), bridge(**several)))
    np.testing.assert_array_equal(changed[:, :2], plain[:, :2])
    rows = {"time": np.zeros(1)}
    np.testing.assert_array_equal(
        Simulator(bridge(**several)).predict(rows), Simulator(bridge()).predict(rows)
    )


def test_a_file_keeps_them() -> None:
    model = bridge(gain=GAIN, swap=SWAP, dead=DEAD)
    again = read_model(model_content(model), "again")
    assert again.effects == model.effects
    assert [one.points_named() for one in again.effects.values()] == [
        [POINTS[0]], [POINTS[0], POINTS[2]], [POINTS[1]],
    ]  # fmt: skip
    assert all(one.sensors_named() == [] for one in again.effects.values())
    kinds = {kind for kind, one in Effect.vocabulary.items() if one.at_points()}
    assert {"sensor_gain", "sensor_swap", "sensor_fault"} <= kinds


@pytest.mark.parametrize(
    ("effect", "said"),
    [
        ({"kind": "sensor_gain", "factor": -1.0}, "give one of the two"),
        ({"kind": "sensor_fault", "mode": "dead"}, r"\(give point\): give one of the two"),
        ({"kind": "sensor_swap"}, r"\(give sensors\).*\(give points\): give one of the two"),
        (GAIN | {"sensor": "D1"}, "give one of the two"),
        (DEAD | {"sensor": "D1"}, "give one of the two"),
        (SWAP | {"sensors": ["D1", "D1"]}, "give one of the two"),
        (GAIN | {"point": "A1"}, "there is no point 'A1' in the model"),
        (SWAP | {"points": ["A1", POINTS[0]]}, "there is no point 'A1' in the model"),
        (GAIN | {"point": []}, "names no point"),
        (SWAP | {"points": [POINTS[0]] * 2}, "points: name two that differ"),
    ],
    ids=str,
)
def test_what_makes_no_sense_is_refused(effect: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        bridge(own=effect)
