"""Loggers that were set to zero or started anew, and nobody wrote it down: said, not explained.

Each record stands beside its twin with nothing wrong, and beside causes that move many channels.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from findings_invariants import check_invariants
from rga import Findings, diagnose
from rga.diagnosis.preparation.prepare import prepare
from site_truss import MEMBERS, NOISE, ROWS, STEP, Array, Logged, Site, logged, model

LATE, ZEROED = 70, (0, 12)
BEGUN = (np.arange(ROWS) >= LATE).astype(float)
OFF, ANEW = "off by a constant", "jump together"
seeds = pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.thorough)])


def found(log: Logged, zero: tuple[int, int] | None = None) -> Findings:
    findings = diagnose(model(), log.record(zero=zero))
    check_invariants(findings)
    return findings


def tared(log: Logged, rows: slice = slice(*ZEROED)) -> Logged:
    """Set to zero, and nobody says so."""
    return changed(log, lambda name, column: column - column[rows].mean())


def changed(log: Logged, change: Callable[[str, Array], Array]) -> Logged:
    return replace(log, readings={n: change(n, column) for n, column in log.readings.items()})


def noise(name: str) -> float:
    return NOISE["microstrain" if name.startswith("S ") else "mm"]


@seeds
def test_a_zero_that_nobody_declared_is_told_with_its_rows(seed: int) -> None:
    log = logged(Site(), seed)
    findings = found(tared(log))
    assert (findings.verdict, findings.misfits) == ("unknown", [])
    words = findings.unexplained.looks_like
    assert f"channels are {OFF}" in words
    assert "rows 1 to 12" in words
    assert f"zero = [0, {11 * STEP:g}]" in words
    assert "%" not in words.split(";")[0]
    declared = found(log, ZEROED)
    assert declared.verdict == "nothing_wrong"
    for twin in (declared, found(log)):
        assert OFF not in twin.sentence()


@seeds
def test_a_cause_beside_a_zero_that_nobody_declared_is_no_name_alone(seed: int) -> None:
    findings = found(tared(logged(Site(sinks=0.005 * BEGUN), seed)))
    assert [one.effect["kind"] for one in findings.causes] == ["support_settlement"]
    assert findings.verdict == "partial"
    assert OFF in findings.unexplained.looks_like


@seeds
@pytest.mark.parametrize("rows", [slice(60, 65), slice(0, ROWS), slice(0, 1)])
def test_a_zero_of_other_rows_is_told(seed: int, rows: slice) -> None:
    prepared = prepare(model(), tared(logged(Site(), seed), rows).record(), lambda done: None)
    (told,) = [one for one in [*prepared.doubts, *prepared.warnings] if "import.toml" in one]
    assert f"rows {rows.start + 1} to {rows.stop} " in told


@seeds
@pytest.mark.parametrize("at_zero", [True, False])
def test_channels_that_jump_together_are_a_logger_started_anew(seed: int, at_zero: bool) -> None:
    log = logged(Site(), seed)
    some = list(log.readings)[:9]
    draw = np.random.default_rng(seed)

    def jumping(name: str, column: Array) -> Array:
        if name not in some:
            return column
        jump = -column[LATE] if at_zero else 40 * noise(name) * draw.standard_normal()
        return column + jump * BEGUN

    findings = found(changed(log, jumping))
    assert (findings.verdict, findings.misfits) == ("unknown", [])
    words = findings.unexplained.looks_like
    assert f"of 16 channels {ANEW} at row {LATE + 1} ({LATE * STEP:g} s)" in words
    assert ("to a reading of zero" in words) == at_zero
    assert "as two records" in words
    assert ANEW not in found(log).sentence()


def late(name: str) -> Site:
    """A site with something that begins late and moves many channels."""
    few = {"L2-L3": 0.5, "U2-U3": 0.6}
    worn = np.zeros((ROWS, len(MEMBERS)))
    worn[:, MEMBERS.index("L2-L3")] = 3e-4 * BEGUN
    return {
        "settlement": Site(sinks=0.005 * BEGUN),
        "lengthened": Site(stretched=worn),
        "both": Site(sinks=0.005 * BEGUN, stretched=worn),
        "bearing": Site(roller=5e7 * BEGUN),
        "load": Site(down={"U3": 2e4 * BEGUN}),
        "loads": Site(down={"U3": 2e4 * BEGUN, "L2": 1e4 * BEGUN}, sinks=0.002 * BEGUN),
        "more load": Site(loads={"west load": 1 + 0.5 * BEGUN}),
        "thinned": Site(area=few),
        "welded": Site(welded=True),
    }[name]


@seeds
@pytest.mark.parametrize(
    "name",
    [
        *("settlement", "lengthened", "both", "bearing", "load", "loads", "more load"),
        *("thinned", "welded"),
    ],
)
def test_what_a_structure_does_at_once_is_no_logger(seed: int, name: str) -> None:
    prepared = prepare(model(), logged(late(name), seed).record(), lambda done: None)
    assert prepared.doubts == []


@seeds
@pytest.mark.parametrize("context", ["temperature", "west load"])
def test_a_context_that_is_off_is_no_logger(seed: int, context: str) -> None:
    log = logged(Site(), seed)
    for share in (1.0, BEGUN):
        biased = {**log.contexts, context: log.contexts[context] + 15 * share}
        record = replace(log, contexts=biased).record()
        assert prepare(model(), record, lambda done: None).doubts == []
