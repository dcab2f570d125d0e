"""Streams on which detectors are judged: noise, faults, and the same rows in any blocks."""

from copy import deepcopy

import numpy as np
import pytest

from chance_detector import Coin, Rows, courses
from rga_bench.detection.charts import Chart, Method, detecting
from rga_bench.detection.detectors import Mewma
from rga_bench.detection.faults import Drift, Spikes, Spread, Step, StreamChange, Stuck
from rga_bench.detection.noise import WHITE, WORLDS, NoiseSource, StationaryNoise
from rga_bench.detection.streams import ResidualStream
from rga_bench.detection.watch import StreamWorld, WatchedCase, watched

SEED = np.random.SeedSequence(1)


@pytest.mark.parametrize("noise", WORLDS, ids=lambda noise: noise.name)
def test_noise_has_the_moments_it_is_named_for(noise: StationaryNoise) -> None:
    rows = NoiseSource(noise, 8, SEED).take(40_000)
    assert np.allclose(rows.mean(axis=0), 0.0, atol=0.05)
    assert np.allclose(rows.var(axis=0), 1.0, atol=0.06)
    later = np.mean(rows[1:] * rows[:-1])
    assert later == pytest.approx(noise.memory, abs=0.02)
    assert np.mean(rows[2:] * rows[:-2]) == pytest.approx(noise.memory**2, abs=0.02)
    across = np.corrcoef(rows.T)[np.triu_indices(8, 1)]
    assert np.allclose(across, noise.shared, atol=0.03)
    tails = np.mean(np.abs(rows) > 4.0)
    assert (tails > 1e-3) == bool(noise.freedom)


def test_noise_begins_as_it_goes_on() -> None:
    noise = StationaryNoise("slow", memory=0.9)
    first = [NoiseSource(noise, 500, np.random.SeedSequence(n)).take(2) for n in range(20)]
    assert np.var([rows[0] for rows in first]) == pytest.approx(1.0, abs=0.05)
    assert np.mean([rows[0] * rows[1] for rows in first]) == pytest.approx(0.9, abs=0.05)


FAULTS = [
    Step(2.0, 3), Step(2.0, 3, signed=True), Drift(0.1, 3), Spread(3.0, 3), Stuck(0.0), Spikes(8.0),
]  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
@pytest.mark.parametrize("noise", [WHITE, WORLDS[2], WORLDS[4]], ids=lambda noise: noise.name)
def test_a_stream_is_the_same_in_any_blocks(fault: StreamChange, noise: StationaryNoise) -> None:
    whole = ResidualStream(noise, 7, SEED, fault, 50).take(300)
    parts = ResidualStream(noise, 7, SEED, fault, 50)
    cut = np.concatenate([parts.take(size) for size in (20, 30, 1, 9, 140, 100)])
    assert np.array_equal(whole, cut)
    sound = ResidualStream(noise, 7, SEED).take(300)
    assert np.array_equal(whole[:50], sound[:50])
    changed = np.any(whole != sound, axis=0)
    assert changed.sum() == fault.count
    assert np.array_equal(whole[:, ~changed], sound[:, ~changed])


def test_what_faults_do() -> None:
    def change(fault: StreamChange) -> tuple[Rows, Rows]:
        sound = ResidualStream(WHITE, 5, SEED).take(5050)
        faulty = ResidualStream(WHITE, 5, SEED, fault, 50).take(5050)
        own = np.any(faulty != sound, axis=0)
        return sound[:, own], faulty[:, own]

    sound, faulty = change(Step(2.0, 3))
    assert np.allclose(faulty[50:] - sound[50:], 2.0)
    sound, faulty = change(Step(2.0, 5, signed=True))
    assert set(np.round((faulty - sound)[50:].ravel(), 9)) == {-2.0, 2.0}
    sound, faulty = change(Drift(0.1, 2))
    assert np.allclose((faulty - sound)[50:], 0.1 * np.arange(1, 5001)[:, None])
    sound, faulty = change(Spread(3.0, 2))
    assert np.allclose(faulty[50:], 3.0 * sound[50:])
    sound, faulty = change(Stuck(0.0))
    assert np.all(faulty[50:] == sound[49])
    sound, faulty = change(Spikes(8.0))
    jumps = (faulty - sound)[50:]
    assert set(np.round(jumps.ravel(), 9)) == {-8.0, 0.0, 8.0}
    assert 0.01 < np.mean(jumps != 0.0) < 0.03


def test_charts_are_fresh_for_every_stream() -> None:
    def make(baseline: Rows | None, seed: int) -> Chart:
        return Mewma(0.1, np.zeros(4), np.eye(4))

    method = Method("mewma", make, 1e9)
    one, _ = courses(method, 2, 200)
    alone = make(None, 0).values(StreamWorld(3, sensors=4).stream(WatchedCase(2, 200), 0).take(200))
    assert one.values[-1] == alone.max()
    chart = make(None, 0)
    twin = deepcopy(chart)
    chart.values(np.ones((5, 4)))
    assert twin.values(np.zeros((1, 4))) == 0.0


def test_a_baseline_serves_its_streams_only() -> None:
    seen: list[tuple[float, int]] = []

    def make(baseline: Rows | None, seed: int) -> Coin:
        assert baseline is not None
        assert baseline.shape == (30, 4)
        seen.append((float(baseline[0, 0]), seed))
        return Coin(0.5)

    world = StreamWorld(3, sensors=4, baseline=30, each=2)
    watched(world, WatchedCase(6, 10), detecting("coin", make))
    assert len(set(seen)) == len(seen) == 3
    watched(world, WatchedCase(6, 10), detecting("coin", make), range(2, 4))
    assert seen[3:] == seen[1:2]
