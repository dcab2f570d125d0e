"""Measured modes: their noise from repeats, and the mean of their shapes."""

from dataclasses import replace

import numpy as np
import pytest

from independent.modal_bridge import MISSING, NOISE, Hidden, Parked, measured
from rga.diagnosis.modal.readings import ModalReadings, mean_shape
from rga.errors import InputError
from rga.model import read_effect
from rga.model.schema import ContextVariable


def test_noise_is_that_of_repeats_and_a_step_is_none() -> None:
    steady = ModalReadings.of(*measured(1, Hidden(), windows=300))
    moved = ModalReadings.of(
        *measured(1, Hidden(stiffness={"bottom bracing": 0.7}, onset=150), windows=300)
    )
    np.testing.assert_allclose(steady.scatter, NOISE, rtol=0.25)
    np.testing.assert_allclose(moved.scatter, NOISE, rtol=0.35)
    np.testing.assert_allclose(steady.found, 1.0 - MISSING, atol=0.06)
    assert np.abs(steady.memory - 0.3).max() < 0.25


def test_shapes_are_turned_onto_each_other() -> None:
    shape = np.array([1.0, -2.0, 0.5])
    entries = np.array([shape, -3.0 * shape, [2.0, np.nan, 1.0], [np.nan] * 3])
    mean, at, noise = mean_shape(entries, np.array([0.9, -2.2, 0.4]))
    np.testing.assert_allclose(mean, shape / np.linalg.norm(shape), atol=1e-9)
    assert at.tolist() == [0, 1, 2]
    assert noise < 1e-12


@pytest.mark.parametrize("points", [3, 4, 7])
def test_a_shape_that_is_the_same_in_all_windows_has_no_noise(points: int) -> None:
    """MAC of what is alike is rounded to more than one as well."""
    for shape in np.random.default_rng(points).normal(size=(50, points)):
        mean, _, noise = mean_shape(np.tile(shape, (10, 1)), shape)
        np.testing.assert_allclose(np.abs(mean @ shape), np.linalg.norm(shape))
        assert 0.0 <= noise < 1e-12


def test_without_shapes_nothing_is_said_of_them() -> None:
    mean, at, noise = mean_shape(np.full((3, 2), np.nan), np.array([1.0, 1.0]))
    assert (len(mean), len(at), noise) == (0, 0, 0.0)


def test_a_shape_of_a_single_point_is_none() -> None:
    alone = np.array([[2.0, np.nan], [np.nan, 1.0]])
    mean, at, noise = mean_shape(alone, np.array([1.0, 1.0]))
    assert (len(mean), len(at), noise) == (0, 0, 0.0)
    mean, at, _ = mean_shape(np.vstack([alone, [3.0, 4.0]]), np.array([1.0, 1.0]))
    np.testing.assert_allclose(mean, [0.6, 0.8])


def test_what_is_measured_of_a_mode_in_which_all_points_stand_still_is_no_shape() -> None:
    model, record = measured(1, Hidden(), windows=5)
    first, *others = model.modes
    still = dict.fromkeys(model.modes[first].shape, 0.0)
    unseen = model.modes[first].model_copy(update={"shape": still})
    readings = ModalReadings.of(
        model.model_copy(update={"modes": {**model.modes, first: unseen}}), record
    )
    looks = dict(zip(readings.modes, readings.looks, strict=True))
    assert not len(looks[first].at)
    assert all(len(looks[name].at) for name in others)
    (words,) = readings.unclear
    assert words.startswith(f"no point sees mode {first}: all stand still in it")


def test_windows_without_what_drives_the_structure_are_left_out() -> None:
    model, record = measured(1, Hidden(), windows=20)
    softer = {"kind": "member_stiffness", "group": "bottom bracing", "factor": {"context": "frost"}}
    frost = ContextVariable(unit="-", range=(0.5, 1.0))
    model = model.model_copy(update={"context": {"frost": frost}})
    model = model.extended({"soft": read_effect(softer, "soft")})
    known = np.where(record.windows < 12, 0.5 + 0.02 * record.windows, np.nan)
    readings = ModalReadings.of(model, replace(record, contexts={"frost": known}))
    assert (len(readings.time), readings.uncovered) == (12, 8)
    with pytest.raises(InputError, match="'frost' is not known in any window"):
        ModalReadings.of(model, replace(record, contexts={"frost": np.full(len(record), np.nan)}))


def test_windows_without_the_weather_are_left_out_and_a_rare_context_is_not_used() -> None:
    model, record = measured(1, Hidden(), windows=20)
    air = np.where(record.windows % 4 == 0, np.nan, 1.0 * record.windows)
    readings = ModalReadings.of(model, replace(record, contexts={"air": air}))
    assert (len(readings.time), readings.uncovered) == (15, 5)
    assert np.isfinite(readings.weather["air"]).all()
    rare = np.where(record.windows < 12, np.nan, 1.0 * record.windows)
    readings = ModalReadings.of(model, replace(record, contexts={"air": rare}))
    assert (len(readings.time), readings.uncovered, readings.weather) == (20, 0, {})
    assert readings.record.left_out[-1] == "air (known in fewer than half of the windows)"


@pytest.mark.parametrize("without", [2, 12])
def test_windows_in_doubt_are_left_out_where_they_are_few(without: int) -> None:
    """Where no shape was measured, frequencies decide nothing between neighbours."""
    model, record = measured(1, Hidden(), windows=20)
    shapes = np.where(record.windows[:, None] < without, np.nan, record.shapes)
    readings = ModalReadings.of(model, replace(record, shapes=shapes))
    found = np.isfinite(readings.log_f[:without]).any()
    if without == 2:
        assert (readings.unsure, readings.doubtful, found) == (without, 0, False)
    else:
        assert (readings.unsure, readings.doubtful, found) == (0, without, True)


def test_a_record_of_other_modes_is_refused() -> None:
    model, record = measured(1, Hidden())
    other = model.model_copy(
        update={
            "modes": {
                name: mode.model_copy(update={"near": 50.0 * mode.near})
                for name, mode in model.modes.items()
            }
        }
    )
    with pytest.raises(InputError, match="none of the modes that the model expects"):
        ModalReadings.of(other, record)


def test_two_modes_that_have_each_others_shape_in_one_window_are_left_out_there() -> None:
    model, record = measured(1, Hidden(), windows=30)
    there = np.flatnonzero(record.windows == 12)
    frequency = record.frequency.copy()
    one, other = there[np.argsort(frequency[there])][:2]
    frequency[[one, other]] = frequency[[other, one]]
    sound, odd = (
        ModalReadings.of(model, each) for each in (record, replace(record, frequency=frequency))
    )
    assert (sound.far_out, odd.far_out) == (0, 2)
    assert (odd.entries[[one, other]] < 0).all()
    left = np.delete(np.arange(len(record)), [one, other])
    np.testing.assert_array_equal(odd.entries[left], sound.entries[left])


@pytest.mark.parametrize(("windows", "left_out"), [(1, True), (2, True), (4, False), (15, False)])
def test_what_lasts_is_a_state_of_the_structure(windows: int, left_out: bool) -> None:
    model, record = measured(1, Hidden(), windows=40)
    there = (record.windows >= 12) & (record.windows < 12 + windows)
    state = replace(record, frequency=np.where(there, 0.9, 1.0) * record.frequency)
    readings = ModalReadings.of(model, state)
    assert readings.far_out == (there.sum() if left_out else 0)


def test_a_truck_that_stands_there_for_one_window_is_a_state_too() -> None:
    model, record = measured(1, Hidden(), windows=40, parked=Parked({"b3n": 6000.0}, (12, 13)))
    there = record.windows == 12
    readings = ModalReadings.of(model, record)
    assert (readings.entries[there] >= 0).sum() > 2
    assert readings.far_out == 0
