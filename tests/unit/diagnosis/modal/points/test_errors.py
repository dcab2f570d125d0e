"""Errors of single points: beside dense covariances, and what they must not see."""

from dataclasses import dataclass

import numpy as np
import pytest

from rga.diagnosis.modal.points.errors import FREE, LEAST, TIMES, WRONG, PointErrors, mixing
from rga.simulation.modal.expected import Expected

POINTS, COMPUTED = 12, 5
LOG_F = np.log([2.0, 3.0, 4.5, 7.0, 9.0])
NUMBER = np.array([0, 1, 3])


def shapes() -> np.ndarray:
    """Sines along a beam."""
    at = (np.arange(POINTS) + 1.0) / (POINTS + 1.0)
    return np.sin(np.pi * np.arange(1, COMPUTED + 1)[:, None] * at)


@dataclass(frozen=True)
class Measured:
    """Three modes, each measured at all points but the last few."""

    looks: list[Expected]
    errors: PointErrors
    sizes: np.ndarray

    @classmethod
    def of(cls, measured: np.ndarray, seen: int = POINTS) -> "Measured":
        at = np.arange(seen)
        looks = [
            Expected(2.0, 0.1, at, one[:seen] / np.linalg.norm(one[:seen])) for one in measured
        ]
        sizes = mixing(looks, LOG_F, shapes(), NUMBER, max(WRONG))
        return cls(looks, PointErrors(looks, shapes(), sizes), sizes)

    def off(self, recorded: np.ndarray) -> list[np.ndarray]:
        return self.errors.off(recorded, self.sizes)

    def covariance(self, mode: int, spread: float, recorded: np.ndarray) -> np.ndarray:
        parts = self.sizes[mode][:, None] * recorded[:, self.looks[mode].at]
        return np.asarray(parts.T @ parts + spread**2 * np.eye(parts.shape[1]))


def scattered() -> np.ndarray:
    noise = 0.05 * np.random.default_rng(3).standard_normal((len(NUMBER), POINTS))
    return np.asarray(shapes()[NUMBER] + noise)


def turned(factor: float) -> np.ndarray:
    recorded = shapes()
    recorded[:, 4] *= factor
    return recorded


@pytest.mark.parametrize("factor", [1.0, -1.0, 0.3, 0.0])
def test_squares_and_freedom_are_those_of_the_dense_covariance(factor: float) -> None:
    found, recorded = Measured.of(scattered()), turned(factor)
    spread = found.errors.spread
    for mode, (off, freedom) in enumerate(
        zip(found.off(recorded), found.errors.freedom(recorded, found.sizes), strict=True)
    ):
        own = found.covariance(mode, spread, recorded)
        shape = found.looks[mode].shape
        np.testing.assert_allclose(off @ off, shape @ np.linalg.solve(own, shape), rtol=1e-9)
        dense = np.linalg.slogdet(own / spread**2)[1]
        np.testing.assert_allclose(freedom, 0.5 * dense, rtol=1e-9)


def test_the_spread_follows_the_point_in_the_middle_left_out() -> None:
    found = Measured.of(scattered())
    left = np.zeros((len(NUMBER), POINTS))
    for mode, look in enumerate(found.looks):
        own = found.covariance(mode, LEAST, shapes())
        for point in range(POINTS):
            others = np.arange(POINTS) != point
            told = own[point, others] @ np.linalg.solve(
                own[np.ix_(others, others)], look.shape[others]
            )
            left[mode, point] = look.shape[point] - told
    middle = np.sqrt(np.median((left**2).mean(0)))
    np.testing.assert_allclose(found.errors.spread, TIMES * middle, rtol=1e-8)
    assert Measured.of(shapes()[NUMBER]).errors.spread == LEAST


def test_a_mixture_of_modes_is_no_error_of_a_point_and_a_turned_sensor_is() -> None:
    # A stiffness that is wrong by an eighth here and there mixes modes by half of that over the
    # distance of their frequencies.
    apart = LOG_F - LOG_F[NUMBER][:, None]
    mixed = np.divide(0.0625, apart, out=np.ones_like(apart), where=apart != 0.0)
    structure = Measured.of(mixed @ shapes())
    sensor = Measured.of(turned(-1.0)[NUMBER])
    mixtures, off, known = (
        np.concatenate(one.off(recorded))
        for one, recorded in (
            (structure, shapes()), (sensor, shapes()), (sensor, turned(-1.0)),
        )
    )  # fmt: skip
    assert mixtures @ mixtures < 3.0
    assert known @ known < 3.0
    by_point = (off.reshape(len(NUMBER), POINTS) ** 2).sum(0)
    assert by_point.argmax() == 4
    # What is left of it beside mixtures is about it, and by far the most there.
    assert by_point[4] > max(100.0, 3.0 * np.delete(by_point, 4).max())


def test_a_point_that_is_wrong_does_not_widen_what_all_may_be_off() -> None:
    noise = 0.002 * np.random.default_rng(3).standard_normal((len(NUMBER), POINTS))
    right = Measured.of(shapes()[NUMBER] + noise)
    wrong = Measured.of(turned(0.5)[NUMBER] + noise)
    assert wrong.errors.spread < 1.5 * right.errors.spread
    off = np.concatenate(wrong.off(shapes()))
    assert off @ off > 10.0 * off.size


def test_where_points_are_few_mixtures_explain_all() -> None:
    few = Measured.of(turned(-1.0)[NUMBER], seen=5)
    off = np.concatenate(few.off(shapes()))
    assert off @ off < off.size


def test_modes_mix_by_what_is_wrong_over_the_distance_of_their_frequencies() -> None:
    found = Measured.of(scattered())
    for mode, number in enumerate(NUMBER):
        length = np.linalg.norm(shapes()[number])
        for other in range(COMPUTED):
            apart = abs(LOG_F[other] - LOG_F[number])
            share = FREE if other == number else min(1.0, max(WRONG) / (2.0 * apart))
            np.testing.assert_allclose(found.sizes[mode, other], share / length, rtol=1e-12)
