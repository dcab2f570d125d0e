"""`rga benchmark detector`: what is measured, the tables, the targets, the command."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from chance_detector import coin
from rga_bench.detection.detectors import MONITOR, WINDOW_RULE
from rga_bench.detection.experiment import DetectionExperiment
from rga_bench.detection.faults import Step
from rga_bench.detection.optimum import (
    OPTIMUM,
)
from rga_bench.detection.rates import Arl0, Delay, Share
from rga_bench.detection.result import Alarms, Seen
from rga_bench.detection.setting import DetectionSetting
from rga_bench.detection.table import page
from rga_bench.detection.targets import targets
from rga_bench.experiment import Execution

#: as little as can be measured
LITTLE = DetectionSetting(
    arl0=500.0, null=20, streams=10, baselines=2, each=2, onset=110, sensors=6, sizes=(1.0,),
    counts=(1, 6), seconds=0.02,
)  # fmt: skip


@pytest.mark.thorough
def test_any_number_of_processes_finds_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "rga_bench.detection.experiment.ready", lambda sensors, arl0: ()
    )  # thresholds take their time
    monkeypatch.setattr(
        "rga_bench.detection.experiment.throughput", lambda seconds, seed: []
    )  # as peers do
    experiment = DetectionExperiment(LITTLE)
    one, two = (experiment.measure(Execution(workers=workers)) for workers in (1, 2))
    assert replace(one, day="") == replace(two, day="")
    other = DetectionExperiment(replace(LITTLE, seed=1)).measure(Execution())
    assert other.delays != one.delays


@pytest.mark.thorough
def test_a_detector_of_ones_own_stands_in_the_tables() -> None:
    shares: list[float] = []
    experiment = DetectionExperiment(LITTLE, [coin(0.01)])
    result = experiment.measure(Execution(progress=shares.append))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    text = page(result, "rga benchmark detector --seed 0").text()
    assert "| change | sensors | window rule | MEWMA | monitor | coin | optimum |" in text
    (line,) = [line for line in text.splitlines() if line.startswith("| coin |  | white | known")]
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
def test_targets(rows: float, verdicts: list[str]) -> None:
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
    monkeypatch.setattr(
        "rga_bench.detection.experiment.shorter", lambda seed: replace(LITTLE, seed=seed)
    )
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


def test_a_place_that_cannot_be_written_is_reported_before_anything_is_measured(
    rga: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(DetectionExperiment, "measure", None)
    taken = tmp_path / "file"
    taken.touch()
    ran = rga("benchmark", "detector", "-o", taken)
    assert ran.code == 2
    assert "the output is a file" in ran.err
