"""What planned measurements show: predictions of both explanations, with their intervals."""

from dataclasses import replace

import numpy as np
import pytest

from rga.experiments.explanation import HALF_WIDTH
from rga.experiments.measurement_model import Errors, MeasurementModel
from rga.experiments.separation import Pair
from rga.planning.predictions import planned_sensor, planned_test
from rga.planning.selection import Choice


def test_a_test_shows_the_readings_that_differ_most(
    bridge: MeasurementModel, errors: Errors, pair: Pair
) -> None:
    number = 1
    shown = planned_test(bridge, errors, [pair], Choice((), (number,), np.zeros(1)), number)
    row = bridge.operating + number
    spread = np.hypot(errors.noise[row], errors.gain[row])
    apart = np.abs(pair.difference[row]) / spread
    order = np.argsort(-apart[: bridge.standing])
    assert shown.tells[0].sensor == bridge.sensors[order[0]]
    assert shown.words == bridge.tests[number].words
    assert shown.cost == bridge.tests[number].cost
    first = shown.tells[0]
    values = [one.value for one in first.says]
    assert values == pytest.approx(pair.predicted[:, row, order[0]].tolist())
    assert [one.explanation for one in first.says] == [pair.cause.words, pair.rival.words]


def test_an_interval_holds_noise_gain_scatter_and_unknowns(
    bridge: MeasurementModel, errors: Errors, pair: Pair
) -> None:
    number = 1
    row = bridge.operating + number
    shown = planned_test(bridge, errors, [pair], Choice((), (number,), np.zeros(1)), number)
    reading = shown.tells[0]
    column = bridge.sensors.index(reading.sensor)
    variance = errors.noise[row, column] ** 2 + errors.gain[row, column] ** 2
    variance += (errors.shared[:, row, column] ** 2).sum()
    for says, unknown in zip(reading.says, pair.unknown[:, row, column], strict=True):
        low, high = says.ci90
        assert (low + high) / 2 == pytest.approx(says.value)
        assert (high - low) / 2 == pytest.approx(HALF_WIDTH * np.sqrt(variance + unknown**2))


def test_a_sensor_shows_the_largest_change_in_operation(
    bridge: MeasurementModel, errors: Errors, pair: Pair
) -> None:
    column = bridge.standing + int(
        np.argmax(np.ptp(pair.difference[: bridge.operating, bridge.standing :], axis=0))
    )
    shown = planned_sensor(bridge, errors, [pair], Choice((column,), (), np.zeros(1)), column)
    added = bridge.added[column - bridge.standing]
    assert (shown.words, shown.unit, shown.cost) == (added.words, added.unit, added.cost)
    (change,) = shown.tells
    difference = change.says[0].value - change.says[1].value
    assert difference == pytest.approx(np.ptp(pair.difference[: bridge.operating, column]))
    assert change.change.startswith("from ")
    still = replace(pair, predicted=np.zeros_like(pair.predicted))
    silent = planned_sensor(bridge, errors, [still], Choice((column,), (), np.zeros(1)), column)
    assert silent.tells == []
    beside = planned_sensor(bridge, errors, [still], Choice((column,), (0,), np.zeros(1)), column)
    assert [one.change for one in beside.tells] == [bridge.tests[0].words]
