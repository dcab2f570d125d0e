"""Scatter: derivatives by members and gains, levels that suit a record, lines that may move."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.noise.random_effects import (
    level_evidence,
    lines,
    scatter_effects,
    scatter_levels,
)
from rga.diagnosis.search.linearised import Problem, load_basis
from rga.model import read_effect


def effects(posed: Problem, family: int) -> np.ndarray:
    """Random effects of a family, float[effects, rows, sensors]."""
    which = np.flatnonzero(posed.scatter.family == family)
    every = np.eye(len(posed.scatter.family))
    return np.array([posed.scatter.effects.at(every[number]) for number in which])


def test_members_scatter_as_their_stiffness_changes_the_readings(posed: Problem) -> None:
    members = list(posed.simulator.model.members)
    shown = effects(posed, 0)
    assert len(shown) == len(members)
    for number in (0, 5):
        content = {"kind": "member_stiffness", "member": members[number], "factor": np.exp(1e-4)}
        simulator = posed.simulator.extended({"softer": read_effect(content, "test")})
        change = (posed.data.predict(simulator) - posed.simulated) / 1e-4
        scale = np.abs(change).max()
        np.testing.assert_allclose(shown[number], change, atol=2e-3 * scale)


def test_gains_scatter_as_each_channel_reads(posed: Problem) -> None:
    shown = effects(posed, 1)
    assert len(shown) == len(posed.data.sensors)
    for number, one in enumerate(shown):
        np.testing.assert_allclose(one[:, number], posed.simulated[:, number], atol=1e-6)
        assert not np.delete(one, number, axis=1).any()


def test_a_spread_is_the_level_of_the_family_or_its_own(posed: Problem) -> None:
    levels = np.array([0.1, 0.2, 0.3])
    spread, family = posed.scatter.spread(levels), posed.scatter.family
    for number, level in enumerate(levels):
        assert (spread[family == number] == level).all()
    np.testing.assert_array_equal(spread[family < 0], posed.scatter.fixed[family < 0])


def scattered(posed: Problem, level: float) -> np.ndarray:
    """A residual of gains that are off by so much, and noise."""
    draw = np.random.default_rng(6)
    gains = level * draw.standard_normal(len(posed.data.sensors))
    noise = posed.noise.sigma * draw.standard_normal(posed.simulated.shape)
    return np.asarray(posed.simulated * gains + noise)


def test_levels_follow_the_scatter_of_a_record(posed: Problem) -> None:
    found = [
        scatter_levels(posed.covariance, posed.scatter, scattered(posed, level), posed.levels)[1]
        for level in (0.0, 0.03)
    ]
    assert found[0] < 0.01
    assert found[1] == pytest.approx(0.03, rel=0.5)


def test_a_scatter_that_is_there_has_more_evidence_with_its_levels(posed: Problem) -> None:
    residual = scattered(posed, 0.03)
    free = level_evidence(posed.covariance, posed.scatter, residual, posed.levels)
    none = posed.covariance.with_spread(posed.scatter.spread(np.full(3, 1e-4)))
    reduced = none.reduce(residual.T[None])
    score, own = reduced.score[:, 0], (reduced.white**2).sum() - (reduced.context**2).sum()
    assert free > none.log_likelihood(score)[0] - 0.5 * float(own) + 10


def test_a_line_may_move_up_and_turn(posed: Problem) -> None:
    assert lines(posed.data) == []
    belief = replace(posed.data.belief, lines={"cart": (5.0, 0.1), "level": (2.0, 0.0)})
    moves = lines(replace(posed.data, belief=belief))
    assert [(name, spread) for name, _, spread in moves] == [
        ("cart", 5.0), ("cart", 0.1), ("level", 2.0),
    ]  # fmt: skip
    assert (moves[0][1] == 1).all()
    np.testing.assert_allclose(moves[1][1], posed.data.time - posed.data.time.mean())


def test_courses_know_no_units(posed: Problem) -> None:
    """An effect may be a billion times a reading, if a billionth of it is likely at most."""
    rows, sensors = posed.simulated.shape
    clock = (posed.data.time - posed.data.time.mean()) / np.ptp(posed.data.time)
    course = np.outer(np.sin(9 * clock), posed.simulated.std(0))
    zeros = [(np.tile(1e9 * one, (rows, 1)), 1e-9) for one in np.eye(sensors)]
    found = scatter_effects(
        posed.simulator,
        posed.data,
        posed.simulated,
        load_basis(posed.simulator, posed.data),
        np.zeros((sensors, 0)),
        [*zeros, (course, 0.01)],
    )
    number = int(np.flatnonzero(found.family < 0)[len(zeros)])
    shown = found.effects.at(np.eye(len(found.family))[number])
    np.testing.assert_allclose(shown, course, atol=1e-4 * abs(course).max())
