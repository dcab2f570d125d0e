"""Which baselines the monitor warns of, over many draws."""

from typing import Any

import numpy as np
import pytest

from rga.detection import SyncMonitor
from unchanged_streams import BASELINE, WORLDS, Rows, noise


def warned_of(rows: Rows) -> bool:
    return bool(SyncMonitor(rows, arl0=1000).warnings)


@pytest.mark.parametrize("world", WORLDS)
def test_a_stationary_baseline_is_not_warned_of(world: str) -> None:
    """One in a hundred may be."""
    assert sum(warned_of(noise(world, BASELINE, seed)) for seed in range(40)) <= 3


def test_many_sensors_that_go_together_are_warned_of_only_where_one_changes() -> None:
    generator = np.random.default_rng(4)
    for _ in range(6):
        rows = generator.normal(size=(1000, 84)) + generator.normal(size=(1000, 1))
        assert not warned_of(rows)
        rows[500:, 3] += 1.0
        assert warned_of(rows)


def drift(rows: Rows) -> None:
    rows[:, 2] += np.linspace(0.0, 2.5, len(rows)) * rows[:, 2].std()


def long_drift(rows: Rows) -> None:
    rows[:, 2] += np.linspace(0.0, 10.0, len(rows)) * rows[:, 2].std()


def step(rows: Rows) -> None:
    rows[len(rows) // 2 :, 2] += 1.5 * rows[:, 2].std()


def high_step(rows: Rows) -> None:
    rows[len(rows) // 2 :, 2] += 10.0 * rows[:, 2].std()


def louder(rows: Rows) -> None:
    rows[len(rows) // 2 :, 2] *= 2.0


@pytest.mark.parametrize("world", ["white", "heavy tails", "correlated"])
@pytest.mark.parametrize("change", [drift, long_drift, step, high_step, louder])
def test_a_baseline_that_changes_is_warned_of(world: str, change: Any) -> None:
    found = 0
    for seed in range(10):
        rows = noise(world, BASELINE, seed)
        change(rows)
        found += warned_of(rows)
    assert found >= 8


def test_a_baseline_that_wanders_is_warned_of() -> None:
    walks = [np.cumsum(noise("white", BASELINE, seed), axis=0) for seed in range(10)]
    assert sum(warned_of(walk) for walk in walks) >= 6


@pytest.mark.parametrize(
    ("rows", "sensors"), [(60, 84), (30, 1), (30, 6), (60, 1), (400, 1), (35, 20)]
)
def test_short_and_narrow_baselines_are_learned(rows: int, sensors: int) -> None:
    generator = np.random.default_rng(3)
    alarms = 0
    for _ in range(10):
        readings = generator.normal(size=(rows + 300, sensors))
        monitor = SyncMonitor(readings[:rows], arl0=3_000)
        alarms += bool(monitor.update_many(readings[rows:])[-1])
    assert alarms <= 5
