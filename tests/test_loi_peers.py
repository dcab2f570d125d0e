"""Peers that others made, where they are installed."""

from dataclasses import replace

import numpy as np
import pytest

from loi_problems import coverage, easy, error, measured
from rga.benchmark.loi.methods import domain_adaptation, neural_posterior
from rga.benchmark.loi.methods.domain_adaptation import skada_coral, skada_dann

NEEDS = {"neural_posterior": "sbi", "skada_coral": "skada", "skada_dann": "skada"}
METHODS = [neural_posterior.neural_posterior, skada_coral, skada_dann]


@pytest.fixture(params=METHODS, ids=lambda method: method.__name__)
def method(request, monkeypatch):
    needed = NEEDS[request.param.__name__]
    pytest.importorskip(needed, reason=f"{needed} is not installed (rga[inference-peers])")
    monkeypatch.setattr(neural_posterior, "DRAWS", 1000)
    monkeypatch.setattr(neural_posterior, "EPOCHS", 15)
    monkeypatch.setattr(domain_adaptation, "EPOCHS", 30)
    return request.param


def test_a_peer_learns_without_labels_and_alike_each_time(method):
    problem, judged = easy()
    labelled = replace(problem, load_tests=measured(problem, np.random.default_rng(3), 5))
    learned, again = method(problem), method(labelled)
    assert error(problem, learned, judged) < 0.75
    rows = judged.readings[:7]
    assert np.array_equal(learned.infer(rows).value, again.infer(rows).value)


def test_no_row_one_row_and_missing_readings(method):
    problem, judged = easy()
    learned = method(problem)
    assert learned.infer(judged.readings[:0]).value.shape == (0, len(problem.ranges))
    assert learned.infer(judged.readings[:1]).value.shape == (1, len(problem.ranges))
    gappy = judged.readings[:6].copy()
    gappy[:, 3] = np.nan
    assert np.isfinite(learned.infer(gappy).value).all()


def test_a_neural_posterior_covers():
    pytest.importorskip("sbi", reason="sbi is not installed (rga[inference-peers])")
    problem, judged = easy()
    learned = neural_posterior.neural_posterior(problem)
    assert coverage(learned, judged) > 0.8
