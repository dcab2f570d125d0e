"""`rga benchmark detector`: a coin's false alarms and delays, the optimum, streams, the command."""

import json
import math
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rga.detection import GaussianWindow
from rga_bench.detection import run, setting, table
from rga_bench.detection.charts import Chart, Method, detecting
from rga_bench.detection.detectors import MONITOR, WINDOW_RULE, Mewma, WindowChart, mewma
from rga_bench.detection.faults import Drift, Spikes, Spread, Step, StreamChange, Stuck
from rga_bench.detection.noise import WHITE, WORLDS, NoiseSource, StationaryNoise
from rga_bench.detection.optimum import (
    OPTIMUM,
    Optimum,
    expected_delay,
    optimal,
    optimal_limit,
)
from rga_bench.detection.rates import Arl0, Delay, Share, arl0, delay, limit_for, share
from rga_bench.detection.result import Alarms, Seen
from rga_bench.detection.setting import DetectionSetting
from rga_bench.detection.streams import ResidualStream
from rga_bench.detection.targets import targets
from rga_bench.detection.watch import Course, StreamWorld, WatchedCase, watched

Rows = NDArray[np.float64]
SEED = np.random.SeedSequence(1)
#: as little as can be measured
LITTLE = DetectionSetting(
    arl0=500.0, null=20, streams=10, baselines=2, each=2, onset=110, sensors=6, sizes=(1.0,),
    counts=(1, 6), seconds=0.02,
)  # fmt: skip


class Coin:
    """Alarms with a known probability at every row, whatever the rows are."""

    def __init__(self, probability: float) -> None:
        self.probability = probability

    def update_many(self, rows: Rows) -> NDArray[np.bool_]:
        return (1e6 * rows) % 1.0 < 1.0 - (1.0 - self.probability) ** (1.0 / rows.shape[1])


def coin(probability: float) -> Method:
    return detecting("coin", lambda baseline, seed: Coin(probability))


def courses(method: Method, streams: int, cap: int, **case: Any) -> list[Course]:
    return watched(StreamWorld(3, sensors=4), WatchedCase(streams, cap, **case), method)


@pytest.mark.parametrize("probability", [0.3, 0.01])
def test_a_coin_has_the_false_alarms_it_is_made_for(probability: float) -> None:
    found = courses(coin(probability), 300, 400)
    told = arl0(found, 0.5)
    assert told.rows is not None
    assert told.high is not None
    assert told.low is not None
    assert told.low < 1.0 / probability < told.high
    assert told.low < told.rows < told.high
    assert told.high / told.low < 1.4
    assert told.alarms == sum(one.length(0.5)[1] for one in found)
    quiet = share(found, 0.5, 50)
    assert quiet.low <= (1.0 - probability) ** 50 <= quiet.high


def test_run_lengths_that_are_not_exponential_are_told() -> None:
    coins = courses(coin(0.01), 200, 400)
    clockwork = [Course(-math.inf, np.array([100.0]), np.ones(1), 100)] * 200
    for found, low, high in ((coins, 0.01, 1.0), (clockwork, 0.0, 1e-6)):
        told = arl0(found, 0.5).exponential
        assert told is not None
        assert low <= told < high
    assert arl0(courses(coin(0.5), 50, 400), 0.5).exponential is None


@pytest.mark.parametrize("fault", [Step(0.5), Step(50.0, 4), Drift(1.0, 2), Spread(9.0, 3)])
def test_a_coin_is_as_late_whatever_happens(fault: StreamChange) -> None:
    told = delay(courses(coin(0.02), 300, 2000, onset=20, fault=fault), 0.5)
    assert told.low is not None
    assert told.high is not None
    assert told.low < 50.0 < told.high
    assert told.runs + told.left_out == 300
    assert 0.2 < told.left_out / 300 < 0.45  # 1 - 0.98^20 is 0.33


def test_nothing_alarms() -> None:
    found = courses(coin(0.0), 5, 100, onset=10, fault=Step(9.0))
    told, late = arl0(found, 0.5), delay(found, 0.5)
    assert (told.rows, told.high, told.alarms, told.watched) == (None, None, 0, 500)
    assert told.low == pytest.approx(500.0 / -math.log(0.05))
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


def likelihood(fault: StreamChange, rows: Rows) -> Rows:
    """Ratio of a change from the first of the rows on, for each sensor."""
    ramp = np.arange(1, len(rows) + 1)[:, None] if isinstance(fault, Drift) else 1.0
    if isinstance(fault, Spread):
        logs = rows**2 * (1 - fault.size**-2) / 2 - math.log(fault.size)
        return np.exp(logs.sum(axis=0))
    means = [sign * fault.size * ramp for sign in ((1, -1) if fault.signed else (1,))]
    return np.mean([np.exp((rows * mean - mean**2 / 2).sum(axis=0)) for mean in means], axis=0)


OPTIMA = [Step(1.0, 2), Step(1.0, 2, True), Step(0.7, 6), Drift(0.1, 2), Spread(2.0, 2), Step(2.0)]


@pytest.mark.parametrize("fault", OPTIMA, ids=lambda fault: f"{fault.name} in {fault.count}")
def test_the_optimum_is_the_sum_of_mean_likelihood_ratios(fault: StreamChange) -> None:
    rows = np.random.default_rng(4).standard_normal((12, 6))
    rows[5:, :2] += 1.0
    chart = Optimum(fault, 6, 1000.0)
    found = np.concatenate([chart.values(part) for part in (rows[:5], rows[5:6], rows[6:])])
    for last in range(1, 13):
        ratio = 0.0
        for onset in range(last):
            single = likelihood(fault, rows[onset:last])
            subsets = combinations(single, fault.count)
            ratio += np.mean([math.prod(subset) for subset in subsets])
        assert found[last - 1] == pytest.approx(math.log(ratio))


def test_there_is_no_optimum_for_a_stuck_sensor() -> None:
    with pytest.raises(TypeError, match="stuck"):
        Optimum(Stuck(0.0), 4, 100.0)


@pytest.mark.parametrize("fault", [Step(1.0, 2), Drift(0.1), Spread(2.0)])
def test_the_optimum_keeps_its_rate_and_is_soon(fault: StreamChange) -> None:
    """The limit comes from streams with the change; those without it have the rate."""
    world, rate = StreamWorld(7, sensors=10), 200.0
    method = optimal(fault, 10, rate)
    changed = watched(world, WatchedCase(200, 5000, 50, fault), method)
    limit = optimal_limit(changed, rate)
    assert limit < math.log(rate)
    sound = watched(world, WatchedCase(150, 5000, purpose="null"), replace(method, limit=limit))
    told, late = arl0(sound, limit), delay(changed, limit)
    assert told.low is not None
    assert told.high is not None
    assert 0.9 * told.low < rate < 1.1 * told.high
    assert late.mean is not None
    assert 1.0 < late.mean < 1.2 * expected_delay(fault, 10, rate)


def test_a_thinned_optimum_keeps_its_rate() -> None:
    """A small step is waited for so long that not every onset is kept."""
    fault, rate = Step(0.2, 1), 200.0
    assert expected_delay(fault, 2, rate) > 200
    method = optimal(fault, 2, rate)
    world = StreamWorld(8, sensors=2)
    limit = optimal_limit(watched(world, WatchedCase(200, 9000, 100, fault), method), rate)
    sound = arl0(watched(world, WatchedCase(150, 9000), replace(method, limit=limit)), limit)
    assert sound.low is not None
    assert sound.high is not None
    assert 0.9 * sound.low < rate < 1.1 * sound.high


def test_the_window_rule_decides_as_the_gaussian_window() -> None:
    rows = NoiseSource(WORLDS[3], 9, SEED).take(2000)
    rows[700:1200, 4] = rows[700, 4]  # stuck, and free again
    chart = WindowChart(30, np.zeros(9))
    parts = [chart.values(part) for part in np.split(rows, [7, 20, 31, 700, 701, 1500])]
    expected = GaussianWindow(9, 30, 6.0).update_many(rows**2).any(axis=1)
    assert 10 < expected.sum() < 1500
    assert np.array_equal(np.concatenate(parts) > 6.0, expected)


def test_mewma_is_hotellings_statistic() -> None:
    rows = NoiseSource(WHITE, 5, SEED).take(3000) @ np.diag([1.0, 2.0, 3.0, 4.0, 5.0]) + 7.0
    chart = mewma(5, rows, 0)
    found = np.concatenate([chart.values(rows[:100]), chart.values(rows[100:])])
    average, center, inverse = np.zeros(5), rows.mean(axis=0), np.linalg.inv(np.cov(rows.T))
    for number, row in enumerate(rows[:150], start=1):
        average += 0.05 * (row - center - average)
        variance = 0.05 / 1.95 * (1.0 - 0.95 ** (2 * number))
        assert found[number - 1] == pytest.approx(average @ inverse @ average / variance)
    assert found.mean() == pytest.approx(5.0, abs=0.5)


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


def test_any_number_of_processes_finds_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "ready", lambda sensors, arl0: ())  # thresholds take their time
    one, two = (run.measure(LITTLE, workers=workers) for workers in (1, 2))
    assert replace(one, day="", throughput=[]) == replace(two, day="", throughput=[])
    other = run.measure(replace(LITTLE, seed=1))
    assert other.delays != one.delays


def test_a_detector_of_ones_own_stands_in_the_tables() -> None:
    shares: list[float] = []
    result = run.measure(LITTLE, [coin(0.01)], progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    page = table.markdown(result, "rga benchmark detector --seed 0")
    assert "| change | sensors | window rule | MEWMA | monitor | coin | optimum |" in page
    (line,) = [line for line in page.splitlines() if line.startswith("| coin |  | white | known")]
    (own,) = [one for one in result.alarms if (one.detector, one.known) == ("coin", True)]
    assert own.limit is None
    assert f"({own.quiet.low:.2f} to {own.quiet.high:.2f})" in line
    published = result.alarms[0]
    assert published.detector == WINDOW_RULE
    assert published.limit == 3.0
    assert published.arl0.rows is not None
    assert published.arl0.rows < 20.0
    windows = [one for one in result.points if one.detector == WINDOW_RULE]
    assert windows[0].arl0 < windows[-1].arl0
    assert windows[0].delay < windows[-1].delay
    assert {one.detector for one in result.delays if not one.known} == {
        WINDOW_RULE, "MEWMA", MONITOR, "coin",
    }  # fmt: skip


def late(mean: float) -> Delay:
    return Delay(mean, 0.9 * mean, 1.1 * mean, mean, 100, 0, 0)


@pytest.mark.parametrize(
    ("rows", "verdicts"),
    [
        (10_000.0, ["met", "aim", "aim", "missed"]),
        (5_000.0, ["too many false alarms"] * 3 + ["missed"]),
    ],
)
def test_what_is_asked(rows: float, verdicts: list[str]) -> None:
    """A delay that is bought with false alarms meets nothing."""
    found = [
        Seen(name, "step", Step(1.0, count).name, 1.0, count, True, late(mean))
        for name, count, mean in (
            (OPTIMUM, 1, 20.0), (MONITOR, 1, 26.0), (WINDOW_RULE, 1, 4000.0),
            (OPTIMUM, 5, 10.0), (MONITOR, 5, 13.0),
        )
    ]  # fmt: skip
    alarms = [
        Alarms(MONITOR, None, "white", known, Arl0(rows, 0.9 * rows, 1.1 * rows, 100, 100, None),
               Share(0.7, 0.6, 0.8, 100))
        for known in (True, False)
    ]  # fmt: skip
    judged = targets(10_000.0, alarms, found)
    assert [one.verdict for one in judged] == verdicts
    assert judged[0].value == pytest.approx(1.3)
    assert judged[0].low == pytest.approx(1.3 * math.exp(-0.1 * math.sqrt(2.0)))


def test_the_command(
    rga: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(setting, "shorter", lambda seed: replace(LITTLE, seed=seed))
    folder, file = tmp_path / "out", tmp_path / "figures.json"
    ran = rga(
        "benchmark", "detector", "--quick", "--seed", "3", "--workers", "1",
        "-o", folder, "--json", file,
    )  # fmt: skip
    assert ran.code == 0, ran.err
    assert "Delay, noise known" in ran.out
    names = {path.name for path in folder.iterdir()}
    assert names == {"detector.md", "delays.png", "limits.png"}
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["command"] == "rga benchmark detector --quick --seed 3"
    assert content["setting"]["seed"] == 3
    assert content["versions"]["numpy"]
    assert content["machine"]["processor"]
    page = (folder / "detector.md").read_text(encoding="utf-8")
    assert "`rga benchmark detector --quick --seed 3`" in page
    assert "- seed 3; 6 sensors" in page


def test_a_place_that_cannot_be_written_is_told_before_anything_is_measured(
    rga: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "measure", None)
    taken = tmp_path / "file"
    taken.touch()
    ran = rga("benchmark", "detector", "-o", taken)
    assert ran.code == 2
    assert "the output is a file" in ran.err
