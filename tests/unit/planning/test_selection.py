"""The choice of measurements: as good as an exhaustive search, cheap, and within its budget."""

from collections.abc import Callable
from copy import copy
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from rga.experiments.measurement_model import Errors, MeasurementModel
from rga.experiments.separation import Pair, covariance
from rga.planning.selection import Chooser

ENOUGH = 5.5


@pytest.fixture(scope="module")
def chooser(bridge: MeasurementModel, errors: Errors, pair: Pair) -> Chooser:
    return Chooser(bridge, errors, [pair], ENOUGH)


def test_separation_is_that_of_the_whole_covariance(
    bridge: MeasurementModel, errors: Errors, pair: Pair, chooser: Chooser
) -> None:
    """sqrt(D' C^-1 D) with the unknowns of both explanations in C."""
    present = np.zeros_like(pair.difference)
    sensor, test = bridge.standing + 2, 1
    present[: bridge.operating, sensor] = 1
    present[bridge.operating + test, [*range(bridge.standing), sensor]] = 1
    loose = pair.loose[:, present > 0]
    whole = covariance(errors, present) + loose.T @ loose
    difference = pair.difference[present > 0]
    expected = np.sqrt(difference @ np.linalg.solve(whole, difference))
    assert chooser.separation([sensor], [test]) == pytest.approx([expected], rel=1e-6)
    assert chooser.separation([], []) == pytest.approx([0.0])


def test_one_sensor_is_the_best_of_all_for_its_cost(
    bridge: MeasurementModel, chooser: Chooser
) -> None:
    choice = chooser.best(1, 0)
    (sensor,) = choice.sensors
    assert choice.tests == ()
    alone = {k: chooser.separation([k], [])[0] for k in range(bridge.standing, len(bridge.sensors))}
    costs = {k: bridge.added[k - bridge.standing].cost for k in alone}
    rate = {k: min(one, ENOUGH) ** 2 / costs[k] for k, one in alone.items()}
    assert rate[sensor] == pytest.approx(max(rate.values()), rel=0.05)


def test_two_sensors_are_nearly_those_of_an_exhaustive_search(
    bridge: MeasurementModel, chooser: Chooser
) -> None:
    choice = chooser.best(2, 0)
    assert len(choice.sensors) <= 2
    columns = range(bridge.standing, len(bridge.sensors))
    best = max(chooser.separation(pair, [])[0] for pair in combinations(columns, 2))
    assert min(choice.separation[0], ENOUGH) >= 0.9 * min(best, ENOUGH)


def test_alone_everything_stands_by_what_it_separates(
    bridge: MeasurementModel, chooser: Chooser
) -> None:
    several = chooser.alone()
    assert len(several) == len(bridge.added) + len(bridge.tests)
    for one in several:
        assert len(one.sensors) + len(one.tests) == 1
        assert one.separation == pytest.approx(chooser.separation(one.sensors, one.tests))
    sizes = [min(one.separation[0], ENOUGH) for one in several]
    assert (np.diff(sizes) <= 1e-6).all()


def test_a_test_and_a_sensor_that_tell_nothing_alone_are_bought_together(
    bridge: MeasurementModel, errors: Errors, pair: Pair
) -> None:
    """Explanations that differ in one reading alone: that of an added sensor in a test."""
    row, column = bridge.operating + 1, bridge.standing + 2
    predicted = np.zeros_like(pair.predicted)
    predicted[0, row, column] = 20 * errors.noise[row, column]
    apart = replace(pair, predicted=predicted, unknown=np.zeros_like(pair.unknown))
    chooser = Chooser(bridge, errors, [apart], ENOUGH)
    assert not chooser.best(1, 0).sensors
    assert not chooser.best(0, 1).tests
    choice = chooser.best(1, 1)
    assert (choice.sensors, choice.tests) == ((column,), (1,))


def test_no_budget_buys_nothing(chooser: Chooser) -> None:
    choice = chooser.best(0, 0)
    assert (choice.sensors, choice.tests) == ((), ())
    assert chooser.cost(choice) == 0.0


def test_what_is_needless_is_not_bought(
    bridge: MeasurementModel, errors: Errors, pair: Pair
) -> None:
    """Explanations that any test separates cost one measurement, whatever the budget."""
    apart = Pair(pair.cause, pair.rival, pair.predicted * 50, pair.unknown)
    chooser = Chooser(bridge, errors, [apart], ENOUGH)
    choice = chooser.best(4, 4)
    assert len(choice.sensors) + len(choice.tests) == 1
    cheapest = min(one.cost for one in [*bridge.added, *bridge.tests])
    assert chooser.cost(choice) == pytest.approx(cheapest, abs=0.5)


def test_of_choices_alike_the_advised_one_is_taken(
    bridge: MeasurementModel, chooser: Chooser
) -> None:
    plain = chooser.best(1, 0)
    again = chooser.best(1, 0, (plain.sensors, ()))
    assert again.sensors == plain.sensors
    useless = min(
        range(bridge.standing, len(bridge.sensors)), key=lambda k: chooser.separation([k], [])[0]
    )
    assert chooser.best(1, 0, ((useless,), ())).sensors == plain.sensors


@pytest.fixture(scope="module")
def twin_gauges(
    bridge: MeasurementModel, errors: Errors, pair: Pair, chooser: Chooser
) -> Callable[..., tuple[Chooser, list[int]]]:
    """Sensors at one place, each of them enough by itself, by their costs; and their columns."""
    (column,) = chooser.best(1, 0).sensors

    def at_costs(*costs: float) -> tuple[Chooser, list[int]]:
        columns = [*range(bridge.standing), *(column for _ in costs)]
        site = copy(bridge)
        site.tests = []
        site.sensors = [bridge.sensors[k] for k in columns]
        gauge = bridge.added[column - bridge.standing]
        site.added = [replace(gauge, cost=cost) for cost in costs]
        apart = replace(
            pair,
            predicted=50 * pair.predicted[:, :, columns],
            unknown=pair.unknown[:, :, columns],
        )
        of_site = Errors(
            errors.noise[:, columns], errors.gain[:, columns], errors.shared[:, :, columns]
        )
        chooser = Chooser(site, of_site, [apart], ENOUGH)
        return chooser, [*range(bridge.standing, len(columns))]

    return at_costs


def test_of_measurements_that_are_enough_the_cheapest_is_bought(
    twin_gauges: Callable[..., tuple[Chooser, list[int]]],
) -> None:
    chooser, (_, cheap, _) = twin_gauges(2.0, 1.0, 3.0)
    assert chooser.best(2, 0).sensors == (cheap,)


def test_of_choices_alike_the_advised_one_is_taken_unless_it_costs_more(
    twin_gauges: Callable[..., tuple[Chooser, list[int]]],
) -> None:
    chooser, (first, advised) = twin_gauges(1.0, 1.0)
    assert chooser.best(1, 0).sensors == (first,)
    assert chooser.best(1, 0, ((advised,), ())).sensors == (advised,)
    chooser, (first, advised) = twin_gauges(1.0, 1.1)
    assert chooser.best(1, 0, ((advised,), ())).sensors == (first,)


def test_of_what_is_needless_the_dearest_is_dropped(
    twin_gauges: Callable[..., tuple[Chooser, list[int]]],
) -> None:
    chooser, (_, cheap, dear) = twin_gauges(1.0, 1.0, 3.0)
    assert chooser.best(2, 0, ((cheap, dear), ())).sensors == (cheap,)
    assert chooser.best(2, 0, ((dear, cheap), ())).sensors == (cheap,)
