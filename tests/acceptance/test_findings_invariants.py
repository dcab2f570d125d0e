"""`nothing_wrong` and `named` are safe on any record: what must hold, on drawn ones."""

import os
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from findings_invariants import check_invariants
from rga import Findings, diagnose
from rga_bench.faults import FAULTS
from rga_bench.faults.base import Base, Sound, load
from rga_bench.faults.inject import broken
from rga_bench.faults.trial import FaultTrial

ROWS = 80
#: how many records are drawn: a few in every run, thousands where they are asked for
EXAMPLES = int(os.environ.get("RGA_TEST_EXAMPLES", "2"))


def bases() -> st.SearchStrategy[Base]:
    sources = st.sampled_from(["drawn", "field"])
    return st.builds(lambda name, k: Base(f"{name}-{k}", ROWS), sources, st.integers(0, 99))


@settings(
    max_examples=EXAMPLES,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=list(HealthCheck),
)
@given(
    base=bases(),
    number=st.integers(1, 999),
    way=st.sampled_from(["whole", "late", "pair", "several"]),
    fault=st.sampled_from(sorted(FAULTS)),
)
def test_what_must_hold_holds_of_any_record(base: Base, number: int, way: str, fault: str) -> None:
    sound = load(base, 11)
    record, _ = broken(FaultTrial(base, 11, number, way, fault), sound.model, sound.record)
    check_invariants(diagnose(sound.model, record))


@pytest.fixture(scope="module")
def sound() -> Sound:
    return load(Base("drawn-0", 120), 3)


def with_gain(sound: Sound, factors: dict[str, float]) -> Findings:
    readings = sound.record.readings.copy()
    for name, factor in factors.items():
        readings[:, sound.record.sensors.index(name)] *= factor
    return diagnose(sound.model, replace(sound.record, readings=readings))


def test_a_sound_record_has_nothing_wrong(sound: Sound) -> None:
    findings = diagnose(sound.model, sound.record)
    check_invariants(findings)
    assert findings.verdict == "nothing_wrong"


def test_channels_that_are_off_alike_are_not_nothing(sound: Sound) -> None:
    """All of a kind a fifth too large: no scatter of single gauges."""
    kinds = {name: sound.model.sensors[name].kind for name in sound.record.sensors}
    findings = with_gain(sound, {n: 1.2 for n, kind in kinds.items() if kind == "strain"})
    check_invariants(findings)
    assert findings.verdict != "nothing_wrong"


def test_a_record_of_which_half_is_broken_says_so(sound: Sound) -> None:
    rng = np.random.default_rng(1)
    readings = sound.record.readings.copy()
    few = len(sound.record.sensors) // 2 + 1
    readings[:, :few] += (
        40 * np.nanstd(readings[:, :few], axis=0) * rng.standard_normal((len(readings), few))
    )
    findings = diagnose(sound.model, replace(sound.record, readings=readings))
    check_invariants(findings)
    assert findings.verdict in ("unknown", "partial")
    assert "do not work" in findings.unexplained.looks_like
