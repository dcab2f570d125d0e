"""The optimum that no detector beats, and the charts beside it."""

import math
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from chance_detector import Rows
from rga.detection import GaussianWindow
from rga_bench.detection.detectors import WindowChart, mewma
from rga_bench.detection.faults import Drift, Spread, Step, StreamChange, Stuck
from rga_bench.detection.noise import WHITE, WORLDS, NoiseSource
from rga_bench.detection.optimum import (
    Optimum,
    expected_delay,
    optimal,
    optimal_limit,
)
from rga_bench.detection.rates import arl0, delay
from rga_bench.detection.watch import StreamWorld, WatchedCase, watched

SEED = np.random.SeedSequence(1)


def likelihood(fault: StreamChange, rows: Rows) -> Rows:
    """Ratio of a change from the first of the rows on, for each sensor."""
    ramp = np.arange(1, len(rows) + 1)[:, None] if isinstance(fault, Drift) else 1.0
    if isinstance(fault, Spread):
        logs = rows**2 * (1 - fault.size**-2) / 2 - math.log(fault.size)
        return np.exp(logs.sum(axis=0))
    means = [sign * fault.size * ramp for sign in ((1, -1) if fault.signed else (1,))]
    return np.mean([np.exp((rows * mean - mean**2 / 2).sum(axis=0)) for mean in means], axis=0)


OPTIMA = [Step(1.0, 2), Step(1.0, 2, True), Step(0.7, 6), Drift(0.1, 2), Spread(2.0, 2), Step(2.0)]


@pytest.mark.parametrize("fault", OPTIMA, ids=lambda fault: f"{fault.name} in {fault.count}")
def test_the_optimum_is_the_sum_of_mean_likelihood_ratios(fault: StreamChange) -> None:
    rows = np.random.default_rng(4).standard_normal((12, 6))
    rows[5:, :2] += 1.0
    chart = Optimum(fault, 6, 1000.0)
    found = np.concatenate([chart.values(part) for part in (rows[:5], rows[5:6], rows[6:])])
    for last in range(1, 13):
        ratio = 0.0
        for onset in range(last):
            single = likelihood(fault, rows[onset:last])
            subsets = combinations(single, fault.count)
            ratio += np.mean([math.prod(subset) for subset in subsets])
        assert found[last - 1] == pytest.approx(math.log(ratio))


def test_there_is_no_optimum_for_a_stuck_sensor() -> None:
    with pytest.raises(TypeError, match="stuck"):
        Optimum(Stuck(0.0), 4, 100.0)


@pytest.mark.parametrize("fault", [Step(1.0, 2), Drift(0.1), Spread(2.0)])
def test_the_optimum_keeps_its_rate_and_is_soon(fault: StreamChange) -> None:
    """The limit comes from streams with the change; those without it have the rate."""
    world, rate = StreamWorld(7, sensors=10), 200.0
    method = optimal(fault, 10, rate)
    changed = watched(world, WatchedCase(200, 5000, 50, fault), method)
    limit = optimal_limit(changed, rate)
    assert limit < math.log(rate)
    sound = watched(world, WatchedCase(150, 5000, purpose="null"), replace(method, limit=limit))
    alarms, late = arl0(sound, limit), delay(changed, limit)
    assert alarms.low is not None
    assert alarms.high is not None
    assert 0.9 * alarms.low < rate < 1.1 * alarms.high
    assert late.mean is not None
    assert 1.0 < late.mean < 1.2 * expected_delay(fault, 10, rate)


def test_a_thinned_optimum_keeps_its_rate() -> None:
    """A small step is waited for so long that not every onset is kept."""
    fault, rate = Step(0.2, 1), 200.0
    assert expected_delay(fault, 2, rate) > 200
    method = optimal(fault, 2, rate)
    world = StreamWorld(8, sensors=2)
    limit = optimal_limit(watched(world, WatchedCase(200, 9000, 100, fault), method), rate)
    sound = arl0(watched(world, WatchedCase(150, 9000), replace(method, limit=limit)), limit)
    assert sound.low is not None
    assert sound.high is not None
    assert 0.9 * sound.low < rate < 1.1 * sound.high


def test_the_window_rule_decides_as_the_gaussian_window() -> None:
    rows = NoiseSource(WORLDS[3], 9, SEED).take(2000)
    rows[700:1200, 4] = rows[700, 4]  # stuck, and free again
    chart = WindowChart(30, np.zeros(9))
    parts = [chart.values(part) for part in np.split(rows, [7, 20, 31, 700, 701, 1500])]
    expected = GaussianWindow(9, 30, 6.0).update_many(rows**2).any(axis=1)
    assert 10 < expected.sum() < 1500
    assert np.array_equal(np.concatenate(parts) > 6.0, expected)


def test_mewma_is_hotellings_statistic() -> None:
    rows = NoiseSource(WHITE, 5, SEED).take(3000) @ np.diag([1.0, 2.0, 3.0, 4.0, 5.0]) + 7.0
    chart = mewma(5, rows, 0)
    found = np.concatenate([chart.values(rows[:100]), chart.values(rows[100:])])
    average, center, inverse = np.zeros(5), rows.mean(axis=0), np.linalg.inv(np.cov(rows.T))
    for number, row in enumerate(rows[:150], start=1):
        average += 0.05 * (row - center - average)
        variance = 0.05 / 1.95 * (1.0 - 0.95 ** (2 * number))
        assert found[number - 1] == pytest.approx(average @ inverse @ average / variance)
    assert found.mean() == pytest.approx(5.0, abs=0.5)
