"""Laws of contexts over time: lines among gross errors, constants, smooth courses."""

from typing import Any

import numpy as np
import pytest
from scipy.stats import norm

from rga.inference.laws.over_time import follow_law
from rga.inference.laws.refine import polish_line
from rga.model.schema import ContextVariable

LINE = ContextVariable(unit="m", range=(-100, 100), law="linear", rate=(-5, 5))


def crossing(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Time, estimates, spreads and the line: a third gross errors, a third that say nothing."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 60.0, 0.5)
    line = -30.0 + 1.7 * time
    spread = np.full(len(time), 0.5)
    estimate = line + spread * rng.standard_normal(len(time))
    kind = rng.integers(3, size=len(time))
    estimate[kind == 1] += 25.0
    estimate[kind == 2], spread[kind == 2] = 0.0, 200 / np.sqrt(12)
    return time, estimate, spread, line


@pytest.mark.parametrize("seed", range(4))
def test_a_line_is_found_among_gross_errors(seed: int) -> None:
    time, estimate, spread, line = crossing(seed)
    # Half of the good rows are pulled the same way only where they are a minority.
    estimate = np.where((estimate - line > 10) & (np.arange(len(time)) % 2 == 0), -70.0, estimate)
    value, spread_of_line = follow_law(time, estimate, spread, LINE)
    assert np.abs(value - line).max() < 0.5
    assert (np.abs(value - line) < 5 * spread_of_line).all()
    assert spread_of_line.max() < 2.0


def test_a_line_through_candidates_keeps_to_its_direction() -> None:
    time = np.linspace(0, 20, 80)
    rising, falling = -40 + 3 * time, 35 - 3 * time
    candidates = np.column_stack([rising, rising - 45.0, falling])
    shares = np.tile([0.3, 0.5, 0.2], (len(time), 1))
    spreads = np.full_like(candidates, 0.4)
    backwards = np.array([False, True, False])
    value, _ = follow_law(time, candidates, spreads, LINE, shares, backwards)
    assert np.abs(value - rising).max() < 0.5
    value, _ = follow_law(time, candidates, spreads, LINE, shares, ~backwards)
    assert np.abs(value - falling).max() < 0.5 or np.abs(value - rising + 45).max() < 0.5


def test_the_rate_is_bounded() -> None:
    time = np.linspace(0, 10, 50)
    value, _ = follow_law(time, 9.0 * time - 45, np.full(50, 0.3), LINE)
    assert np.diff(value) / np.diff(time) == pytest.approx(np.full(49, 5.0))


def test_nothing_known_leaves_the_prior() -> None:
    time, blind = np.arange(5.0), np.full(5, 200 / np.sqrt(12))
    for law in ("constant", "smooth"):
        variable = LINE.model_copy(update={"law": law})
        value, spread = follow_law(time, np.full(5, 40.0), blind, variable)
        assert value == pytest.approx(np.zeros(5))
        assert spread == pytest.approx(blind)


def test_a_line_is_polished_though_the_model_is_wrong() -> None:
    """Sensors that are off by 10 % for as long as the load is there; a start in another valley."""
    time = np.linspace(0.0, 40.0, 200)
    places = np.linspace(3.0, 37.0, 12)
    wagons = np.arange(0.0, 30.0, 6.0)

    def influence(position: Any) -> Any:
        axles = np.asarray(position)[:, None, None] - wagons
        return 100 * np.exp(-(((axles - places[:, None]) / 3.0) ** 2)).sum(2)

    covered = []
    for seed in range(40):
        draw = np.random.default_rng(seed)
        truth = -20.0 + 2.0 * time
        seen = influence(truth) * (1 + 0.1 * draw.standard_normal(12))
        seen += draw.standard_normal(seen.shape)
        start = truth + draw.uniform(-6, 6) + draw.uniform(-0.2, 0.2) * (time - 20)
        found, covariance = polish_line(
            influence, seen, np.ones(12), time, start, (-200.0, 200.0), (-5.0, 5.0)
        )
        off = (found - [truth.mean(), 2.0]) / np.sqrt(np.diag(covariance))
        assert abs(found[0] - truth.mean()) < 1.0
        covered.append(np.abs(off) < norm.ppf(0.95))
    assert (np.mean(covered, axis=0) >= 0.75).all()


def test_weak_estimates_of_a_constant_add_up() -> None:
    # Each row holds the prior: the mean of the rows alone would be drawn to the middle.
    rng = np.random.default_rng(3)
    truth, noise, prior = 60.0, 80.0, 200**2 / 12
    seen = truth + noise * rng.standard_normal(4000)
    spread = (1 / noise**2 + 1 / prior) ** -0.5
    rows = seen * spread**2 / noise**2
    constant = LINE.model_copy(update={"law": "constant"})
    value, spread_of_value = follow_law(np.arange(4000.0), rows, np.full(4000, spread), constant)
    assert abs(rows.mean() - truth) > 20
    assert abs(value[0] - truth) < 4 * noise / np.sqrt(4000) + 1
    assert spread_of_value[0] < 5


def test_smooth_follows_and_weighs() -> None:
    rng = np.random.default_rng(5)
    smooth = ContextVariable(unit="K", range=(-20, 20), law="smooth")
    time = np.arange(300.0)
    truth = np.cumsum(0.15 * rng.standard_normal(300))
    rows = truth + rng.standard_normal(300)
    rows[100:110] = np.nan
    value, spread = follow_law(time, rows, np.ones(300), smooth)
    error = value - truth
    assert np.sqrt(np.mean(error**2)) < 0.5
    assert 0.6 < np.mean(np.abs(error) < 1.645 * spread) <= 1.0
    assert spread[105] > 1.1 * spread[150]
    still, _ = follow_law(time, 3 + rng.standard_normal(300), np.ones(300), smooth)
    assert np.ptp(still) < 1.0
