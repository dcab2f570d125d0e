"""Channels that do not work, by loads and other channels; what a cause could do is left alone."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.preparation.sensor_faults.beside_other_channels import (
    broken_channels,
    lone_spikes,
)
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.search.linearised import Problem, load_basis
from rga.numerics.hysteresis import play


def broken(
    posed: Problem, readings: np.ndarray, effects: Sequence[np.ndarray] = (), onsets: bool = True
) -> list[BrokenChannel]:
    data = posed.data
    basis = load_basis(posed.simulator, data)
    model, simulated = posed.simulator.model, posed.simulated
    return broken_channels(
        model,
        data.sensors,
        readings,
        data.observed,
        simulated,
        basis,
        lambda: effects,
        lambda: np.zeros(len(data.sensors)),
        onsets,
        data.criteria.channels,
    )


def spikes(posed: Problem, readings: np.ndarray) -> np.ndarray:
    data = posed.data
    basis = load_basis(posed.simulator, data)
    return lone_spikes(readings, data.observed, basis, data.criteria.channels)


@pytest.fixture
def swing(posed: Problem) -> np.ndarray:
    """A course of its own, in the noise of the third channel."""
    draw = np.random.default_rng(9)
    return np.asarray(
        8 * posed.noise.sigma[2] * np.sign(draw.standard_normal(len(posed.simulated)))
    )


def with_own(posed: Problem, course: np.ndarray, channel: int = 2) -> np.ndarray:
    readings = posed.data.readings.copy()
    readings[:, channel] += course
    return readings


def test_sound_channels_work(posed: Problem) -> None:
    assert broken(posed, posed.data.readings) == []


def test_a_channel_of_its_own_ways_is_erratic(posed: Problem, swing: np.ndarray) -> None:
    (found,) = broken(posed, with_own(posed, swing))
    assert (found.sensor, found.mode, found.row) == ("D3", "erratic", None)


@pytest.mark.parametrize(("rows", "found"), [(24, []), (70, ["D3"])])
def test_few_rows_say_nothing_of_a_channel_of_its_own_ways(
    posed: Problem, swing: np.ndarray, rows: int, found: list[str]
) -> None:
    chosen = np.arange(len(posed.simulated)) < rows
    readings = with_own(posed, swing)[chosen]
    few = replace(posed, data=posed.data.rows(chosen), simulated=posed.simulated[chosen])
    assert [one.sensor for one in broken(few, readings)] == found


@pytest.mark.parametrize("lags", [False, True])
def test_a_channel_on_a_member_that_softens_or_slips_works(
    posed: Problem, swing: np.ndarray, lags: bool
) -> None:
    shown = posed.simulated[:, 2]
    scaled = (shown - shown.mean()) / shown.std()
    course = play(scaled[:, None], np.array([1.0]))[:, 0] if lags else scaled**2
    curve = np.abs(swing) * course / course.std()
    assert broken(posed, with_own(posed, curve)) == []
    shuffled = np.random.default_rng(4).permutation(curve)
    assert [one.sensor for one in broken(posed, with_own(posed, shuffled))] == ["D3"]


def test_a_channel_works_until_it_breaks(posed: Problem, swing: np.ndarray) -> None:
    swing[:70] = 0.0
    (found,) = broken(posed, with_own(posed, swing))
    assert found.sensor == "D3"
    assert found.row is not None
    assert 50 <= found.row <= 75
    assert "it works up to row" in found.why


def test_readings_that_jump_now_and_then_are_spikes(posed: Problem) -> None:
    course = np.zeros(len(posed.simulated))
    course[::9] = 60 * posed.noise.sigma[2]
    (found,) = broken(posed, with_own(posed, course))
    assert (found.sensor, found.mode) == ("D3", "spiking")


def test_what_a_cause_of_the_structure_explains_is_no_fault(
    posed: Problem, swing: np.ndarray
) -> None:
    effect = np.zeros_like(posed.simulated)
    effect[:, 2] = swing
    assert broken(posed, with_own(posed, swing), [effect]) == []


def test_a_shift_is_left_to_the_search(posed: Problem) -> None:
    course = np.where(np.arange(len(posed.simulated)) >= 50, 20 * posed.noise.sigma[2], 0.0)
    assert broken(posed, with_own(posed, course)) == []


def test_lone_readings_far_away_are_spikes_and_shifts_are_none(posed: Problem) -> None:
    course = np.zeros(len(posed.simulated))
    course[[20, 60]] = 200 * posed.noise.sigma[2]
    found = spikes(posed, with_own(posed, course))
    assert sorted(zip(*np.nonzero(found), strict=True)) == [(20, 2), (60, 2)]
    course[60:70] = course[60]
    assert [
        row for row, _ in zip(*np.nonzero(spikes(posed, with_own(posed, course))), strict=True)
    ] == [20]
