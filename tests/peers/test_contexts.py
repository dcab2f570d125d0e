"""Peers that others made, where they are installed."""

from dataclasses import replace

import numpy as np
import pytest

from context_methods import NEEDS
from context_problems import coverage, easy, error, measured
from rga_bench.contexts.methods import domain_adaptation, neural_posterior


@pytest.fixture(scope="module", params=NEEDS, ids=lambda method: method.__name__)
def method(request):
    needed = NEEDS[request.param]
    pytest.importorskip(needed, reason=f"{needed} is not installed (rga[inference-peers])")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(neural_posterior, "DRAWS", 1000)
        patch.setattr(neural_posterior, "EPOCHS", 15)
        patch.setattr(neural_posterior, "SAMPLES", 64)
        patch.setattr(domain_adaptation, "EPOCHS", 20)
        yield request.param


@pytest.fixture(scope="module")
def learned(method):
    return method(easy()[0])


def test_a_peer_learns(learned):
    problem, judged = easy()
    assert error(problem, learned, judged) < 0.75
    spread = learned.estimate(judged.readings[:2]).spread
    assert spread is None or coverage(problem, learned, judged) > 0.8


def test_labels_are_not_looked_at_and_the_same_seed_gives_the_same_bits(method, learned):
    problem, judged = easy()
    tests = measured(problem, np.random.default_rng(3), 5)
    again = method(replace(problem, load_tests=tests))
    rows = judged.readings[:7]
    assert np.array_equal(learned.estimate(rows).value, again.estimate(rows).value)


def test_no_row_one_row_and_missing_readings(learned):
    problem, judged = easy()
    assert learned.estimate(judged.readings[:0]).value.shape == (0, len(problem.ranges))
    assert learned.estimate(judged.readings[:1]).value.shape == (1, len(problem.ranges))
    gappy = judged.readings[:6].copy()
    gappy[:, 3] = np.nan
    assert np.isfinite(learned.estimate(gappy).value).all()
