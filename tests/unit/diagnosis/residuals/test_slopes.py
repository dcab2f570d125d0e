"""Responses to a measured context that bend, beside one that goes in proportion."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.residuals.slopes import bends, linear_histories, squares, with_free_slopes
from rga.diagnosis.search.linearised import Problem


def following(posed: Problem, by: str, power: int) -> Problem:
    """The response to the temperature with a part that goes with a power of a context."""
    belief = posed.data.belief
    number = list(belief.spread).index("temperature")
    along = posed.covariance.rows.context_jacobian[:, :, number]
    course = linear_histories(posed)[by] ** power
    readings = posed.data.readings + along * course[:, None]
    return replace(posed, data=replace(posed.data, readings=readings))


def test_a_response_in_proportion_does_not_bend(posed: Problem) -> None:
    assert bends(posed) == []
    assert bends(following(posed, "temperature", 1)) == []


def test_one_that_goes_with_the_square_does(posed: Problem) -> None:
    (found,) = bends(following(posed, "temperature", 2))
    assert (found.context, found.by) == ("temperature", "temperature")
    assert found.size == pytest.approx(1.0, rel=0.1)
    assert len(found.error) == len(posed.data.time)


def test_the_context_with_which_it_bends_is_named(posed: Problem) -> None:
    (found,) = bends(following(posed, "west load", 2))
    assert (found.context, found.by) == ("temperature", "west load")


def test_free_slopes_take_the_bend_up(posed: Problem) -> None:
    problem = following(posed, "temperature", 2)
    free = with_free_slopes(problem, bends(problem), [])
    assert len(free.covariance.spread) > len(problem.covariance.spread)
    residual = problem.residual(problem.simulated).T[None]
    squared = [
        float(one.covariance.squares(one.covariance.reduce(residual))[0]) for one in (problem, free)
    ]
    assert squared[1] < squared[0]


def test_a_square_is_what_no_line_has() -> None:
    line = np.linspace(-1, 1, 40)
    (found,) = squares({"x": line}).values()
    assert found @ line == pytest.approx(0.0, abs=1e-9)
    assert found.sum() == pytest.approx(0.0, abs=1e-9)
    assert np.corrcoef(found, line**2)[0, 1] == pytest.approx(1.0)
    assert squares({"switch": np.where(line > 0, 1.0, -1.0)}) == {}


def test_time_histories_are_standard_units_of_what_varies(posed: Problem) -> None:
    for column in linear_histories(posed).values():
        assert column.mean() == pytest.approx(0.0, abs=1e-9)
        assert column.std() == pytest.approx(1.0)
