"""Batched least squares: every problem ends where a solver of one problem at a time ends it."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from rga.arrays import FloatArray, IntArray
from rga.numerics.bounded_step import bounded_step
from rga.numerics.gauss_newton import Minimum, minimise

GENERATOR = np.random.default_rng(7)
#: peaks of which readings see sums: nonlinear in place and height
PLACES = np.linspace(-2.0, 2.0, 12)
GOALS = GENERATOR.uniform(-1.2, 1.2, (40, 2))


def peaks(z: FloatArray) -> FloatArray:
    return np.asarray((3.0 + z[:, 1:]) * np.exp(-((PLACES - z[:, :1]) ** 2)))


READINGS = peaks(GOALS) + 0.01 * GENERATOR.standard_normal((40, 12))


def residual(z: FloatArray, of: IntArray) -> FloatArray:
    return np.asarray((peaks(z) - READINGS[of]) / 0.01)


def slope(z: FloatArray, of: IntArray) -> FloatArray:
    shape = np.exp(-((PLACES - z[:, :1]) ** 2))
    by_place = (3.0 + z[:, 1:]) * shape * 2.0 * (PLACES - z[:, :1])
    return np.stack([by_place, shape], axis=2) / 0.01


def found(of: IntArray, bound: float, steps: int = 40) -> Minimum:
    return minimise(
        lambda z, few: residual(z, of[few]),
        lambda z, few: slope(z, of[few]),
        np.zeros((len(of), 2)),
        bound,
        steps,
        gain=1e-9,
    )


@pytest.mark.parametrize("bound", [np.inf, 1.0])
def test_ends_where_a_solver_of_single_problems_ends(bound: float) -> None:
    batch = found(np.arange(40), bound)
    for number in range(40):
        of = np.array([number])

        def with_prior(z: FloatArray, of: IntArray = of) -> FloatArray:
            return np.concatenate([residual(z[None], of)[0], z])

        single = least_squares(with_prior, np.zeros(2), bounds=(-bound, bound), xtol=1e-12)
        np.testing.assert_allclose(batch.z[number], single.x, atol=2e-5)
        assert batch.misfit[number] == pytest.approx(2.0 * single.cost, rel=1e-6)
    assert (np.abs(batch.z) <= bound).all()
    assert (np.abs(batch.z) == bound).any() == np.isfinite(bound)


def test_a_problem_does_not_depend_on_its_neighbours() -> None:
    together = found(np.arange(40), 1.0)
    for number in (3, 17):
        alone = found(np.array([number]), 1.0)
        np.testing.assert_allclose(alone.z[0], together.z[number], rtol=1e-12, atol=1e-14)


def test_a_bad_start_never_raises_the_misfit() -> None:
    """A narrow curved valley (Rosenbrock's, 1960), where full steps overshoot."""
    start = np.array([[-1.2, 1.0], [1.2, -1.0], [-1.9, 2.0]])
    trail = []
    for steps in range(0, 400, 20):
        end = minimise(
            lambda z, _: np.stack([1e3 * (z[:, 1] - z[:, 0] ** 2), 1e2 * (1 - z[:, 0])], axis=1),
            lambda z, _: np.stack(
                [
                    np.stack([-2e3 * z[:, 0], np.full(len(z), 1e3)], axis=1),
                    np.stack([np.full(len(z), -1e2), np.zeros(len(z))], axis=1),
                ],
                axis=1,
            ),
            start,
            bound=2.0,
            steps=steps,
            gain=1e-12,
        )
        trail.append(end.misfit)
    assert (np.diff(trail, axis=0) <= 1e-9).all()
    # The prior pulls 6e-4 along the valley.
    np.testing.assert_allclose(end.z, 1.0, atol=7e-4)


def test_no_step_gives_the_start_and_its_information() -> None:
    of = np.arange(5)
    start = found(of, np.inf, steps=0)
    np.testing.assert_array_equal(start.z, 0.0)
    columns = slope(np.zeros((5, 2)), of)
    np.testing.assert_allclose(start.normal, columns.transpose(0, 2, 1) @ columns + np.eye(2))


def test_where_no_step_helps_the_start_stays() -> None:
    """The slope has the wrong sign; no function is called for no problem."""
    calls = []

    def away(z: FloatArray, of: IntArray) -> FloatArray:
        calls.append(len(of))
        return 10.0 * (z - 1.0)

    def wrong(z: FloatArray, of: IntArray) -> FloatArray:
        calls.append(len(of))
        return np.full((len(z), 1, 1), -10.0)

    start = np.array([[0.5], [0.2]])
    end = minimise(away, wrong, start, bound=3.0, steps=10, gain=1e-9)
    assert min(calls) > 0
    assert (np.abs(end.z - start) < 1e-3).all()


def test_a_bounded_step_is_best_inside_the_box() -> None:
    """No point of the box has less of the quadratic than where the step ends."""
    root = GENERATOR.standard_normal((20, 3, 3))
    normal = root @ root.transpose(0, 2, 1) + 0.1 * np.eye(3)
    descent, here = GENERATOR.standard_normal((20, 3)) * 3, GENERATOR.uniform(-1, 1, (20, 3))
    step = bounded_step(normal, descent, here, np.zeros(20), 1.0)
    assert (np.abs(here + step) <= 1.0 + 1e-12).all()

    def quadratic(s: FloatArray) -> FloatArray:
        return np.asarray(
            0.5 * np.einsum("nki,nij,nkj->nk", s, normal, s) - np.einsum("nki,ni->nk", s, descent)
        )

    others = GENERATOR.uniform(-1, 1, (20, 4000, 3)) - here[:, None]
    assert (quadratic(others).min(axis=1) >= quadratic(step[:, None])[:, 0] - 1e-9).all()
