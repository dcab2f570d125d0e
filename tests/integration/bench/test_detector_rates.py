"""Rates of false alarms and delays, as a coin has them by what it is made of."""

import math
from dataclasses import replace

import numpy as np
import pytest

from chance_detector import Rows, coin, courses
from rga_bench.detection.charts import Method
from rga_bench.detection.faults import Drift, Spread, Step, StreamChange
from rga_bench.detection.rates import Delay, arl0, delay, limit_for, share
from rga_bench.detection.watch import Course


@pytest.mark.parametrize("probability", [0.3, 0.01])
def test_a_coin_has_the_false_alarms_it_is_made_for(probability: float) -> None:
    found = courses(coin(probability), 300, 400)
    rate = arl0(found, 0.5)
    assert rate.rows is not None
    assert rate.high is not None
    assert rate.low is not None
    assert rate.low < 1.0 / probability < rate.high
    assert rate.low < rate.rows < rate.high
    assert rate.high / rate.low < 1.4
    assert rate.alarms == sum(one.length(0.5)[1] for one in found)
    quiet = share(found, 0.5, 50)
    assert quiet.low <= (1.0 - probability) ** 50 <= quiet.high


def test_run_lengths_that_are_not_exponential_are_reported() -> None:
    coins = courses(coin(0.01), 200, 400)
    clockwork = [Course(-math.inf, np.array([100.0]), np.ones(1), 100)] * 200
    for found, low, high in ((coins, 0.01, 1.0), (clockwork, 0.0, 1e-6)):
        exponential = arl0(found, 0.5).exponential
        assert exponential is not None
        assert low <= exponential < high
    assert arl0(courses(coin(0.5), 50, 400), 0.5).exponential is None


@pytest.mark.parametrize("fault", [Step(0.5), Step(50.0, 4), Drift(1.0, 2), Spread(9.0, 3)])
def test_a_coin_is_as_late_whatever_happens(fault: StreamChange) -> None:
    late = delay(courses(coin(0.02), 300, 2000, onset=20, fault=fault), 0.5)
    assert late.low is not None
    assert late.high is not None
    assert late.low < 50.0 < late.high
    assert late.runs + late.left_out == 300
    assert 0.2 < late.left_out / 300 < 0.45  # 1 - 0.98^20 is 0.33


def test_nothing_alarms() -> None:
    found = courses(coin(0.0), 5, 100, onset=10, fault=Step(9.0))
    rate, late = arl0(found, 0.5), delay(found, 0.5)
    assert (rate.rows, rate.high, rate.alarms, rate.watched) == (None, None, 0, 500)
    assert rate.low == pytest.approx(500.0 / -math.log(0.05))
    assert (late.mean, late.capped, late.left_out) == (100.0, 5, 0)
    assert share(found, 0.5, 100).share == 1.0


def test_everything_alarms() -> None:
    found = courses(coin(1.0), 5, 100, onset=10, fault=Step(9.0))
    assert arl0(found, 0.5).rows == 1.0
    assert delay(found, 0.5) == Delay(None, None, None, None, 0, 5, 0)


def test_streams_of_one_baseline_say_less() -> None:
    """Half the baselines never alarm, the others at once: 40 streams are worth ten."""
    lasting, short = (Course(-math.inf, np.array([rows]), np.ones(1), 200) for rows in (150.0, 5.0))
    found = [one for _ in range(5) for one in [*[lasting] * 4, *[short] * 4]]
    alone, together = share(found, 0.5, 100), share(found, 0.5, 100, each=4)
    assert alone.share == together.share == 0.5
    assert together.high - together.low > 1.7 * (alone.high - alone.low)
    nothing = share([short] * 40, 0.5, 100, each=4)
    assert nothing.share == 0.0
    assert nothing.high > 0.1
    assert arl0(found, 0.5, each=4).rows == arl0(found, 0.5).rows
    late = delay(found, 0.5, each=4)
    assert late.low is not None
    assert late.low < 60.0
    assert delay(found, 0.5).low > late.low


def test_the_limit_for_a_rate() -> None:
    """The squared first reading exceeds 6.635 once in a hundred rows."""

    class Squares:
        def values(self, rows: Rows) -> Rows:
            return rows[:, 0] ** 2

    method = Method("squares", lambda baseline, seed: Squares(), math.inf)
    found = courses(method, 300, 500)
    limit = limit_for(found, 100.0)
    assert limit == pytest.approx(6.635, rel=0.08)
    others = courses(replace(method, limit=limit), 300, 500, purpose="other")
    again = arl0(others, limit).rows
    assert again is not None
    assert again == pytest.approx(100.0, rel=0.2)
    with pytest.raises(ArithmeticError, match="no alarm"):
        limit_for(courses(method, 2, 50), 1e6)
