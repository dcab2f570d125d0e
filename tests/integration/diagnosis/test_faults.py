"""Broken channels: each fault changes a column as it says, and what a diagnosis makes of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga_bench.experiment import Execution
from rga_bench.faults import FAULTS, Scale
from rga_bench.faults.base import Base, foreign, load
from rga_bench.faults.comparison import Comparison, comparisons
from rga_bench.faults.experiment import FaultsExperiment
from rga_bench.faults.inject import broken as broken_channels
from rga_bench.faults.judge import ERROR, FaultOutcome
from rga_bench.faults.table import page
from rga_bench.faults.trial import LEFT_OUT, SOUND, WAYS, FaultTrial, trials

ROWS, ONSET = 240, 90
SENSOR = {"kind": "strain", "unit": "microstrain", "noise": 1.0}


def sound() -> np.ndarray:
    rng = np.random.default_rng(5)
    return 100.0 + 60.0 * np.sin(np.arange(ROWS) / 15.0) + rng.standard_normal(ROWS)


def other() -> np.ndarray:
    return 40.0 * np.cos(np.arange(ROWS) / 9.0)


def broken(name: str, column: np.ndarray, seed: int = 1, onset: int = 0) -> np.ndarray:
    scale = Scale.of(SENSOR, sound())
    return FAULTS[name].spoil(column, np.random.default_rng(seed), scale, other(), onset)


def test_there_are_the_faults_that_loggers_have() -> None:
    assert len(FAULTS) >= 17
    for name, fault in FAULTS.items():
        assert fault.name == name
        assert fault.happens.endswith(".")
        assert set(fault.source.split()) <= set("NBKH")


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_seen_from_its_onset_only_and_is_drawn_again(name: str) -> None:
    column = sound()
    before = column.copy()
    for seed in range(5):
        whole, late = broken(name, column, seed), broken(name, column, seed, ONSET)
        assert np.array_equal(column, before)
        assert np.array_equal(late[:ONSET], column[:ONSET])
        for changed, first in ((whole, 0), (late, ONSET)):
            off = (changed - column)[first:]
            assert np.sqrt((off**2).sum()) > 10.0
            assert np.abs(off).max() > 5.0
        assert np.array_equal(whole, broken(name, column, seed))
        assert np.array_equal(late, broken(name, column, seed, ONSET))


@pytest.mark.parametrize("name", FAULTS)
def test_what_is_missing_stays_missing(name: str) -> None:
    column = sound()
    column[[0, 40, 41, ROWS - 1]] = np.nan
    assert np.array_equal(np.isnan(broken(name, column)), np.isnan(column))
    nothing = np.full(ROWS, np.nan)
    assert np.isnan(broken(name, nothing)).all()


def test_each_changes_the_column_as_it_says() -> None:
    column, scale = sound(), Scale.of(SENSOR, sound())
    off = {name: broken(name, column) - column for name in FAULTS}
    reads = {name: broken(name, column) for name in FAULTS}
    assert np.array_equal(reads["sign"], -column)
    assert np.array_equal(reads["thousandfold"], 1000.0 * column)
    assert np.array_equal(reads["copy"], other())
    assert np.array_equal(reads["stuck"], np.full(ROWS, column[0]))
    assert off["noise"].std() > 5.0 * scale.noise
    assert abs(np.corrcoef(off["noise"][1:], off["noise"][:-1])[0, 1]) < 0.2
    assert np.corrcoef(off["wander"][1:], off["wander"][:-1])[0, 1] > 0.9
    assert 2 <= len(np.unique(np.round(off["jumps"], 6))) <= 6
    assert (reads["zeros"] == 0.0).mean() >= 0.1
    assert set(off["zeros"][reads["zeros"] != 0.0]) == {0.0}
    assert 0.05 <= max((off["clipping"] != 0.0).mean(), 0.0) <= 0.75
    rails = reads["bad contact"][off["bad contact"] != 0.0]
    assert set(np.abs(rails)) == {scale.full}
    size = np.sqrt(2.0) * off["mains"].std()
    assert np.abs(off["mains"]).max() == pytest.approx(size, rel=0.15)
    growth = np.abs(np.diff(off["creep"]))
    assert (np.diff(growth) < 0).all()
    assert len(np.unique(np.round(reads["one bit"], 6))) <= 4
    assert (off["spikes"] != 0.0).mean() < 0.15
    assert reads["dead"].std() == pytest.approx(scale.noise, rel=0.3)
    assert abs(reads["dead"].mean()) < scale.noise
    assert np.abs(reads["swings"]).max() > 0.3 * scale.full
    lags = [np.abs(reads["late"][30:] - column[30 - lag : ROWS - lag]).max() for lag in range(31)]
    assert min(lags) == 0.0
    assert int(np.argmin(lags)) >= 3


def test_a_scale_knows_unit_noise_and_span() -> None:
    column = sound()
    assert Scale.of(SENSOR, column).full == pytest.approx(16_000.0)
    assert Scale.of({**SENSOR, "unit": "m/m"}, column).full == pytest.approx(0.016)
    span = Scale.of(SENSOR, column).span
    assert 110.0 < span < 125.0
    moved = Scale.of({"kind": "displacement", "unit": "mm"}, column)
    assert moved.full == pytest.approx(20.0 * span)
    # The noise of a file that states none is seen in the steps between rows.
    white = np.random.default_rng(2).standard_normal(4000)
    assert Scale.of({"kind": "displacement", "unit": "mm"}, white).noise == pytest.approx(
        1.0, rel=0.1
    )
    sizes = [Scale.of(SENSOR, column).size(np.random.default_rng(k)) for k in range(200)]
    assert min(sizes) >= 0.2 * span
    assert max(sizes) <= span


def compared(now: FaultOutcome, before: FaultOutcome) -> Comparison:
    (one,) = comparisons([before, now])
    return one


def outcome(way: str = "whole", sensor: str = "S1", **changes: Any) -> FaultOutcome:
    """An outcome in which a member is named, and in a broken record a channel beside it."""
    gone = [] if way == SOUND else [{"sensor": sensor, "fault": "noise", "row": 0}]
    member = {"kind": "member_stiffness", "member": "a-b", "rivals": []}
    fault = {"kind": "sensor_fault", "sensor": sensor, "rivals": []}
    usual = FaultOutcome(
        id=f"drawn-0 {way}",
        base="drawn-0",
        way=way,
        fault="" if way == SOUND else "noise",
        broken=gone,
        verdict="named",
        causes=[member, fault] if gone else [member],
        found=[True],
        warnings=[],
        before=9.0,
        after=1.0,
        gain=(7.5, 8.5),
        seconds=2.0,
    )
    return replace(usual, **changes)


def test_a_diagnosis_is_held_against_that_of_the_sound_record() -> None:
    sound = outcome(SOUND, seconds=1.0)
    right = compared(outcome(), sound)
    assert (right.unmoved, right.kept, right.told, right.named, right.calm) == (
        True, True, True, True, False,
    )  # fmt: skip
    assert right.times == 2.0
    member, fault = outcome().causes
    moved = compared(outcome(causes=[{**member, "member": "b-c"}, fault], found=[False]), sound)
    assert (moved.unmoved, moved.kept) == (False, False)
    assert not compared(outcome(causes=[fault]), sound).unmoved
    assert not compared(outcome(causes=[member, member, fault]), sound).unmoved
    rival = {**member, "member": "b-c", "rivals": [{"kind": member["kind"], "member": "a-b"}]}
    assert compared(outcome(causes=[rival, fault]), sound).unmoved
    unreported = compared(outcome(causes=[member]), sound)
    assert (unreported.told, unreported.named, unreported.calm) == (False, False, True)
    # In words, and not as one of the like of another channel.
    for text, reported in (
        ("channel S1 does not fit", True),
        ("channel S11 does not fit: its like (S1, S2) do", False),
        ("channel S11 does not fit", False),
    ):
        one = compared(outcome(causes=[member], warnings=[text]), sound)
        assert (one.told, one.named) == (reported, False)
        said_before = replace(sound, warnings=[text])
        assert not compared(outcome(causes=[member], warnings=[text]), said_before).told
    assert compared(outcome(before=9.0, after=12.0, gain=(-4.0, -2.0)), sound).calm
    nothing = outcome(verdict="nothing_wrong", after=7.28)
    assert compared(nothing, sound).calm
    assert not compared(replace(nothing, after=1.1), sound).calm
    ended = compared(outcome(verdict=ERROR, causes=[], error="ValueError: no"), sound)
    assert not ended.unmoved
    assert not ended.told
    # What was broken before cannot break.
    assert comparisons([replace(sound, causes=outcome().causes), outcome()]) == []


def test_trials_are_balanced() -> None:
    order = trials(1, 6 * 34, 100)
    several = [one for one in order if one.way not in (SOUND, LEFT_OUT)]
    assert len({one.id for one in order}) == len(order)
    assert trials(1, 60, 100) == order[: len(trials(1, 60, 100))]
    for name in FAULTS:
        ways = [one.way for one in several if one.fault == name]
        assert len(ways) == 12
        assert set(ways) == set(WAYS)
    for one in several:
        first = next(k for k, other in enumerate(order) if other.base == one.base)
        assert order[first].way == SOUND


@pytest.mark.parametrize("name", ["drawn-0", "field-1"])
def test_channels_are_broken_as_the_trial_says(name: str) -> None:
    base = Base(name, 60)
    sound = load(base, 1)
    for way, many in (("whole", 1), ("late", 1), ("pair", 2), ("several", 3)):
        trial = FaultTrial(base, 1, 5, way, "creep")
        record, broken = broken_channels(trial, sound.model, sound.record)
        again, _ = broken_channels(trial, sound.model, sound.record)
        assert np.array_equal(record.readings, again.readings, equal_nan=True)
        assert broken[0]["fault"] == "creep"
        assert len({one["sensor"] for one in broken}) == len(broken) >= many
        changed = record.readings != sound.record.readings
        changed &= np.isfinite(sound.record.readings)
        for column, name in enumerate(record.sensors):
            first = next((one["row"] for one in broken if one["sensor"] == name), len(record))
            assert not changed[:first, column].any()
            assert changed[first:, column].any() == (first < len(record))
        if way == "late":
            assert 0.2 * 60 - 1 <= broken[0]["row"] <= 0.7 * 60
    same, nothing = broken_channels(FaultTrial(base, 1, 0, SOUND), sound.model, sound.record)
    assert same is sound.record
    assert nothing == []
    fewer, gone = broken_channels(FaultTrial(base, 1, 1, LEFT_OUT), sound.model, sound.record)
    assert set(fewer.sensors) == set(sound.record.sensors) - {one["sensor"] for one in gone}


def test_a_dead_channel_is_reported_and_in_a_sound_record_nothing() -> None:
    """A tiny run: the table of one broken record, and its null twin."""
    base = Base("drawn-0", 100)
    trials = [FaultTrial(base, 1, 0, SOUND), FaultTrial(base, 1, 1, "whole", "dead")]
    result = FaultsExperiment(trials).measure(Execution())
    sound, dead = result.outcomes
    assert sound.causes == []
    assert sound.verdict == "nothing_wrong"
    (one,) = comparisons(result.outcomes)
    assert one.told
    assert one.unmoved
    assert not one.calm
    text = page(result, "rga benchmark faults").text()
    assert "| one channel, from the first row | 1 | 100 (27..100) | 100 (27..100) |" in text
    assert "| dead | 1 | 100 (27..100) |" in text
    assert "| sign | - | - |" in text
    assert dead.broken[0]["fault"] == "dead"


def test_foreign_data_is_looked_for(rga: Any, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no records here"):
        foreign(tmp_path, None, 100)
    (tmp_path / "practice" / "04").mkdir(parents=True)
    (tmp_path / "practice" / "04" / "model.json").write_text("{}")
    (only,) = foreign(tmp_path, None, 100)
    assert only.name == "practice/04"
    assert [one.base.name for one in trials(1, 12, 100, [only]) if one.way == SOUND] == [
        "drawn-0",
        "field-0",
    ]
    assert trials(1, 18, 100, [only])[-1].base == only
    assert rga("benchmark", "faults", "--data", str(tmp_path / "nowhere")).code == 2
