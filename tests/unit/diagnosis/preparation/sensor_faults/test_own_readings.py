"""Channels whose readings tell by themselves that they do not work, beside sound ones."""

from typing import Any

import numpy as np
import pytest

from rga.diagnosis.preparation.sensor_faults.own_readings import (
    BrokenChannel,
    answers,
    copied,
    dead,
    lost_zeros,
    scaled,
    silent,
    stuck_channels,
)
from rga.findings.criteria.channels import ChannelCriteria
from rga.model import Model

ROWS = 60
DRAW = np.random.default_rng(2)
SIMULATED = 3.0 * np.sin(0.3 * np.arange(ROWS))
SOUND = SIMULATED + 0.1 * DRAW.standard_normal(ROWS)
SEEN = np.ones(ROWS, dtype=bool)
CRITERIA = ChannelCriteria()


def of_stuck(column: np.ndarray) -> list[BrokenChannel]:
    return stuck_channels(("A",), column[:, None], SEEN[:, None], CRITERIA)


def of_silent(column: np.ndarray) -> BrokenChannel | None:
    return silent("A", column, SEEN, SIMULATED, CRITERIA)


def of_copied(readings: np.ndarray, simulated: np.ndarray, number: int) -> BrokenChannel | None:
    seen = np.ones(readings.shape, dtype=bool)
    return copied(("A", "B"), readings, seen, simulated, number, CRITERIA)


def of_dead(column: np.ndarray) -> BrokenChannel | None:
    return dead("A", column, SIMULATED, CRITERIA)


def of_lost(column: np.ndarray, loaded: np.ndarray) -> list[BrokenChannel]:
    return lost_zeros(("A",), column[:, None], SEEN[:, None], loaded, CRITERIA)


def of_scaled(model: Model, readings: np.ndarray, simulated: np.ndarray) -> list[str]:
    sensors = ("S L0-L1", "S L2-L3", "S U1-U2", "S U2-U3")
    seen = np.ones(readings.shape, dtype=bool)
    every = (
        scaled(model, sensors, answers(readings, seen, simulated, CRITERIA), number, CRITERIA)
        for number in range(4)
    )
    return [one.sensor for one in every if one is not None]


@pytest.mark.parametrize(("share", "found"), [(0.0, False), (0.3, False), (0.8, True)])
def test_a_channel_that_mostly_repeats_itself_is_stuck(share: float, found: bool) -> None:
    column = SOUND.copy()
    still = int(share * ROWS)
    column[10 : 10 + still] = column[10]
    faults = of_stuck(column)
    assert [one.mode for one in faults] == ["stuck"] * found
    if found:
        assert f"{(still - 1) / (ROWS - 1):.0%}" in faults[0].why


def test_few_coarse_readings_repeat_by_chance() -> None:
    coarse = np.array([0.0, 0, 0, 1, 1, 1, 1, 0, 0, 0, -1, -1])
    assert (np.diff(coarse) == 0).mean() > CRITERIA.repeats
    seen = np.ones((len(coarse), 1), dtype=bool)
    assert stuck_channels(("A",), coarse[:, None], seen, CRITERIA) == []
    (found,) = stuck_channels(("A",), np.ones((len(coarse), 1)), seen, CRITERIA)
    assert found.mode == "stuck"


@pytest.mark.parametrize(("value", "mode"), [(0.0, "dead"), (1.3, "stuck")])
def test_a_channel_that_falls_silent_is_reported_from_its_row(value: float, mode: str) -> None:
    column = SOUND.copy()
    column[35:] = value
    found = of_silent(column)
    assert found is not None
    assert (found.mode, found.row, found.readings) == (mode, 35, ROWS - 35)
    assert of_silent(SOUND) is None
    column[-1] += 1e-6
    assert of_silent(column) is None


def test_a_channel_may_be_still_where_nothing_moves() -> None:
    quiet = SIMULATED.copy()
    quiet[35:] = quiet[35]
    column = SOUND.copy()
    column[35:] = 1.3
    assert silent("A", column, SEEN, quiet, CRITERIA) is None


def test_the_channel_that_goes_with_the_other_is_the_copy() -> None:
    other = 2.0 * np.cos(0.2 * np.arange(ROWS))
    simulated = np.column_stack([SIMULATED, other])
    readings = np.column_stack([SOUND, other + 0.1 * DRAW.standard_normal(ROWS)])
    assert of_copied(readings, simulated, 0) is of_copied(readings, simulated, 1) is None
    readings[30:, 0] = readings[30:, 1]
    found = of_copied(readings, simulated, 0)
    assert found is not None
    assert (found.mode, found.row, found.readings) == ("copy", 30, 30)
    assert of_copied(readings, simulated, 1) is None
    readings[50:, 0] = SOUND[50:]
    meanwhile = of_copied(readings, simulated, 0)
    assert meanwhile is not None
    assert (meanwhile.row, meanwhile.readings) == (None, 20)


@pytest.mark.parametrize(("size", "found"), [(0.01, True), (0.2, False), (1.0, False)])
def test_a_channel_that_hardly_varies_is_dead(size: float, found: bool) -> None:
    assert (of_dead(size * SIMULATED) is not None) == found


@pytest.mark.parametrize(("off", "found"), [(0.0, 0), (0.2, 0), (2.0, 1)])
def test_a_zero_that_is_lost_over_a_crossing(off: float, found: int) -> None:
    loaded = (np.arange(ROWS) >= 15) & (np.arange(ROWS) < 40)
    column = np.where(loaded, 5.0, 0.0) + 0.05 * DRAW.standard_normal(ROWS)
    column[40:] += off
    faults = of_lost(column, loaded)
    assert len(faults) == found
    assert of_lost(column, np.zeros(ROWS, dtype=bool)) == []


@pytest.mark.parametrize(
    ("factor", "found"), [(1.0, []), (3.0, []), (100.0, ["S U1-U2"]), (1e-3, ["S U1-U2"])]
)
def test_a_channel_in_another_unit_answers_otherwise_than_its_like(
    model: Model, factor: float, found: list[Any]
) -> None:
    simulated = np.column_stack([SIMULATED * k for k in (1.0, 1.5, 0.8, 1.2)])
    readings = simulated + 0.01 * DRAW.standard_normal(simulated.shape)
    readings[:, 2] *= factor
    assert of_scaled(model, readings, simulated) == found


@pytest.mark.parametrize("frozen", [slice(0, 0), slice(0, 160), slice(20, 180)])
def test_a_coarse_channel_is_stuck_where_it_stands_still_for_too_long(frozen: slice) -> None:
    """A logger of coarse steps repeats itself under slow loads; a channel that freezes is stuck."""
    walk = np.round(np.cumsum(np.random.default_rng(3).normal(0.0, 0.07, 240)), 1)
    assert np.mean(np.diff(walk) == 0) > CRITERIA.repeats
    walk[frozen] = walk[frozen.start]
    faults = stuck_channels(("A",), walk[:, None], np.ones((240, 1), dtype=bool), CRITERIA)
    assert [one.mode for one in faults] == ["stuck"] * (frozen.stop > 0)
