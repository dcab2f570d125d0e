"""Streams of the case study as they are drawn: seeds, what is hidden and when, what drifts."""

from __future__ import annotations

import numpy as np
import pytest

from rga_bench.synthetic import STREAM_KINDS, Case, draw_stream
from rga_bench.synthetic.bridges.case_study import SPAN


def same(a: Case, b: Case) -> bool:
    return a.truth == b.truth and all(
        np.array_equal(a.channels[c], b.channels[c], equal_nan=True) for c in a.channels
    )


@pytest.mark.parametrize("hidden", ["drawn", None])
def test_same_seed_same_bits(hidden: str | None) -> None:
    assert same(draw_stream(2, hidden=hidden), draw_stream(2, hidden=hidden))
    assert not same(draw_stream(2, hidden=hidden), draw_stream(3, hidden=hidden))


def test_every_kind_is_drawn() -> None:
    assert {draw_stream(seed, rows=60).truth["kind"] for seed in range(12)} == set(STREAM_KINDS)


@pytest.mark.parametrize("kind", STREAM_KINDS)
@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.thorough)])
def test_hidden_effect_is_clearly_visible_and_comes_late(kind: str, seed: int) -> None:
    hidden = draw_stream(seed, hidden=kind)
    null = draw_stream(seed, hidden=None)
    truth = hidden.truth
    assert truth["kind"] == kind
    assert 25.0 < truth["d_prime"] < 90.0
    assert truth["reality_d_prime"] < 3.0
    late = hidden.time >= truth["onset"]
    assert 0.65 < 1.0 - late.mean() < 0.75
    change = np.stack([hidden.channels[c] - null.channels[c] for c in hidden.channels])
    assert np.nanmax(np.abs(change[:, ~late])) == 0.0
    assert np.nanmax(np.abs(change[:, late])) > 0.3
    assert null.truth["kind"] == "null"
    assert null.truth["d_prime"] == 0.0


def test_drift_is_unlike_any_ordinary_day() -> None:
    for seed in range(8):
        stream = draw_stream(seed, hidden=None)
        drift, contexts = stream.truth["drift"], stream.truth["contexts"]
        novel, ordinary = drift["novel"], drift["ordinary"]
        assert novel["crowd"][0] > 1.5 * ordinary["crowd"][1]
        assert novel["crowd"][1] > stream.model["context"]["crowd"]["range"][1]
        for name in ("position", "eccentricity"):
            low, high = ordinary[name]
            assert novel[name][0] > high or novel[name][1] < low
        assert min(contexts["position"]) > 0.2 * SPAN
        assert max(contexts["position"]) < 0.8 * SPAN
        during = (stream.time >= drift["from"]) & (stream.time <= drift["until"])
        assert 0.1 < during.mean() < 0.3
        assert np.all(np.flatnonzero(during) / len(during) > 0.35)
        assert np.all(np.flatnonzero(during) / len(during) < 0.65)


def test_a_slow_drift_grows_up_to_the_last_row() -> None:
    slow, null = (
        draw_stream(5, hidden=None, **what) for what in ({"slow": True}, {"drift": False})
    )
    drift, crowd = slow.truth["drift"], slow.truth["contexts"]["crowd"]
    assert 0.35 * slow.time[-1] < drift["from"] < 0.45 * slow.time[-1]
    assert drift["until"] == slow.time[-1]
    assert crowd[-1] > 1.5 * drift["ordinary"]["crowd"][1]
    beyond = np.array(crowd) - np.array(null.truth["contexts"]["crowd"])
    thirds = [part.mean() for part in np.array_split(beyond[slow.time >= drift["from"]], 3)]
    assert thirds == sorted(thirds)
    early = slow.time < drift["from"]
    for name, channel in slow.channels.items():
        assert np.array_equal(channel[early], null.channels[name][early], equal_nan=True)


def test_null_twin_has_neither_and_shares_the_rest() -> None:
    stream = draw_stream(5)
    null = draw_stream(5, hidden=None, drift=False)
    assert null.truth["drift"] is None
    assert null.truth["onset"] is None
    untouched = stream.time < stream.truth["drift"]["from"]
    for name, channel in stream.channels.items():
        assert np.array_equal(channel[untouched], null.channels[name][untouched], equal_nan=True)
    assert max(null.truth["contexts"]["crowd"]) <= 2.5
    for name, course in null.truth["contexts"].items():
        low, high = null.model["context"][name]["range"]
        assert low <= min(course)
        assert max(course) <= high
