"""What a cause rests on: the channels that separate it from its rival, and the one it hangs on."""

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.checks.leave_one_out import contrast, hold, unseen_groups
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.linearised import Problem


@pytest.fixture
def sunk(noisy: Problem) -> Hypothesis:
    return candidate(noisy, "support_settlement", support="east", dof="uz")


def with_settlement(noisy: Problem, sunk: Hypothesis, *channels: str) -> Problem:
    """The settlement as some channels show it."""
    change = change_of(noisy, sunk, 0.2)
    shown = np.array([name in channels for name in noisy.data.sensors])
    return with_white_noise(noisy, noisy.residual(noisy.simulated) + change * shown)


def test_a_cause_and_its_rival_differ_most_where_only_one_of_them_acts(
    noisy: Problem, sunk: Hypothesis
) -> None:
    problem = with_settlement(noisy, sunk, "D1", "D2", "D3")
    bias = candidate(problem, "sensor_bias", sensor="D3")
    found = found_with(problem, [sunk], [bias])
    shown = contrast(found, 0, most=2)
    assert shown is not None
    assert shown.channels[0] == "D2"
    assert shown.lead == pytest.approx(found.alternatives[0][0].behind)
    apart = found.fit.simulated - shown.against.simulated
    np.testing.assert_allclose(shown.predicted[:, 0], apart[:, 1])
    expected = np.sqrt((apart[:, 1] ** 2).mean()) / problem.noise.sigma[1]
    assert shown.size[0] == pytest.approx(expected)
    assert shown.size[0] > shown.size[1]
    assert contrast(found_with(problem, [sunk]), 0) is None


def test_a_cause_hangs_on_the_only_channel_that_shows_it(noisy: Problem, sunk: Hypothesis) -> None:
    alone = hold(found_with(with_settlement(noisy, sunk, "D3"), [sunk]), 0)
    assert alone is not None
    assert alone.channel == "D3"
    assert alone.alone
    every = hold(found_with(with_settlement(noisy, sunk, "D1", "D2", "D3"), [sunk]), 0)
    assert every is not None
    assert every.left > 50 > alone.left


def test_a_cause_at_a_sensor_does_not_hang_on_others(noisy: Problem) -> None:
    bias = candidate(noisy, "sensor_bias", sensor="D1")
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change_of(noisy, bias, 0.1))
    found = found_with(problem, [bias])
    held = hold(found, 0)
    assert held is not None
    assert held.channel != "D1"
    assert held.left == pytest.approx(found.log_odds[0], rel=0.01)


def test_every_group_is_predicted_without_it(noisy: Problem, sunk: Hypothesis) -> None:
    problem = with_settlement(noisy, sunk, "D1", "D2", "D3")
    groups = {one.group: one for one in unseen_groups(found_with(problem, [sunk]))}
    assert sorted(name for one in groups.values() for name in one.channels) == sorted(
        problem.data.sensors
    )
    # No other channel shows the settlement: without the displacements it is left open.
    moved = groups["displacement"]
    assert moved.with_causes == pytest.approx(moved.without, rel=0.01)
    assert moved.gap_without > 5
    assert moved.gap_with < 1
    off = np.abs(moved.measured - moved.without)
    assert (off < 2 * moved.left_open + 4 * problem.noise.sigma[:4]).all()
    for group, one in groups.items():
        if group != "displacement":
            assert one.gap_with == pytest.approx(1.0, abs=0.3)
    assert unseen_groups(found_with(problem, [])) == []
