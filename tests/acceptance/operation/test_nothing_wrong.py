"""Streams in which nothing changes: no cause is proposed, alarms are as rare as was asked."""

import json
import logging
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import poisson

import rga
from live_streams import LOW
from rga.model import Model, read_effect, read_model
from rga.records import Record
from rga.simulation import Simulator
from rga.twin import Settings
from rga.twin.runner import Running

#: rows of a day, one every ten minutes, and of a quarter
DAY = 144
QUARTER = 90 * DAY
#: `RGA_TEST_STREAMS=40 RGA_TEST_DAYS=90` is what is promised
STREAMS = int(os.environ.get("RGA_TEST_STREAMS", "4"))
DAYS = int(os.environ.get("RGA_TEST_DAYS", "30"))
SETTINGS = Settings(
    level="C", calibration_rows=2 * DAY, packet=36, settle=12, arl0=QUARTER, adopt="ask"
)


def days(model: Model, count: int, seed: int, sinks: bool = False) -> Record:
    """So many days of a bridge with all contexts measured; on the last but one a bearing sinks."""
    draw = np.random.default_rng(seed)
    time = 600.0 * np.arange(count * DAY)
    contexts = {
        "temperature": 10 + 6 * np.sin(2 * np.pi * time / 86_400),
        "west load": 20 + 30 * draw.random(len(time)),
        "east load": 20 + 30 * draw.random(len(time)),
    }
    onset = {"onset": float(time[-2 * DAY])}
    hidden = {"low": read_effect(LOW | onset, "low")} if sinks else {}
    readings = Simulator(model.extended(hidden)).predict({"time": time, **contexts})
    noise = np.array([float(one.noise or 0) for one in model.sensors.values()])
    readings = readings + noise * draw.standard_normal(readings.shape)
    measured = {
        name: column + float(model.context[name].noise or 0) * draw.standard_normal(len(time))
        for name, column in contexts.items()
    }
    return Record(time, 0.0, "seconds", tuple(model.sensors), readings, measured)


def lived(
    folder: Path,
    content: dict[str, Any],
    record: Record,
    seed: int,
    allowed: Callable[[Running], bool] = lambda running: True,
) -> tuple[int, int]:
    """Alarms and proposals of a twin that takes a record in, by the steps that are allowed."""
    folder.mkdir()
    (folder / "model.json").write_text(json.dumps(content), "utf-8")
    with rga.live(folder / "model.json", folder / "twin", settings=SETTINGS, seed=seed) as twin:
        twin.feed(record)
        alarms = sum(one.kind == "alarm" for one in twin.play(allowed))
        with twin.twin as played:
            return alarms, len(played.proposals())


def assert_calm(folder: Path, content: dict[str, Any], streams: int, length: int) -> None:
    """No stream has a proposal, and all together no more alarms than chance brings, nor fewer."""
    model = read_model(content, "bridge")
    found = [
        lived(folder / str(seed), content, days(model, length, seed), seed)
        for seed in range(1, streams + 1)
    ]
    alarms, proposals = (sum(column) for column in zip(*found, strict=True))
    expected = streams * (length - 2) / 90
    low, high = poisson.interval(0.998, expected)
    told = f"{alarms} alarms, {expected:.2f} expected, {low:.0f} to {high:.0f} allowed: {found}"
    logging.getLogger(__name__).info(told)
    assert proposals == 0, told
    assert low <= alarms <= high, told


def test_of_calm_days_nothing_is_proposed(measured_bridge: dict[str, Any], tmp_path: Path) -> None:
    assert_calm(tmp_path, measured_bridge, 2, 5)


@pytest.mark.thorough
def test_of_calm_quarters_nothing_is_proposed(
    measured_bridge: dict[str, Any], tmp_path: Path
) -> None:
    assert_calm(tmp_path, measured_bridge, STREAMS, DAYS)


def test_what_sinks_on_such_days_raises_an_alarm(
    measured_bridge: dict[str, Any], tmp_path: Path
) -> None:
    def watching(running: Running) -> bool:
        return running.stage != "diagnose"

    record = days(read_model(measured_bridge, "bridge"), 5, 1, sinks=True)
    assert lived(tmp_path / "sunk", measured_bridge, record, 1, watching)[0] > 0
