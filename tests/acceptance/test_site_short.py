"""A record too short to decide says so in one sentence, beside its twins."""

import numpy as np
import pytest

from findings_invariants import check_invariants
from rga import Findings, diagnose
from site_truss import LOADS, MEMBERS, NOISE, SPREAD, STEP, Array, Logged, Site, model

SHORT = "too short to decide"
LOADED = np.array([5, 6])
seeds = pytest.mark.parametrize("seed", [1, 2])


def logged(seed: int, rows: int, loaded: Array, shift: float) -> Logged:
    """Few rows, some of them loaded; channels answer a load otherwise in the last of these."""
    draw = np.random.default_rng(seed)
    contexts = {"temperature": 10 + 0.3 * draw.standard_normal(rows)}
    for load in LOADS:
        contexts[load] = np.zeros(rows)
        contexts[load][loaded] = 40 + 5 * draw.standard_normal(len(loaded))
    none = np.zeros(rows)
    site = Site(roller=none, sinks=none, stretched=np.zeros((rows, len(MEMBERS))))
    built = np.exp(0.01 * draw.standard_normal(len(MEMBERS)))
    readings = site.readings(contexts, built)
    for number, (name, column) in enumerate(readings.items()):
        if number < 8:
            column[loaded[-1]] *= shift
        noise = NOISE["microstrain" if name.startswith("S ") else "mm"]
        readings[name] = column + noise * draw.standard_normal(rows)
    for name, course in contexts.items():
        contexts[name] = course + SPREAD[name] * draw.standard_normal(rows)
    return Logged(STEP * np.arange(rows), readings, contexts)


def found(log: Logged) -> Findings:
    findings = diagnose(model(), log.record())
    check_invariants(findings)
    return findings


@pytest.mark.parametrize("shift", [1.4, 1.0])
@seeds
def test_a_record_that_is_too_short_says_so(seed: int, shift: float) -> None:
    findings = found(logged(seed, 12, LOADED, shift))
    said = findings.unexplained.looks_like.split("; ")
    assert said[0] == (
        f"the record is {SHORT}: the loads move the readings in 2 of its 12 rows, "
        "and 10 such rows are needed"
    )
    assert findings.verdict in ("unknown", "partial")
    if findings.verdict == "unknown":
        assert (said[1:], findings.misfits) == ([], [])


@seeds
def test_a_record_with_more_rows_under_load_is_not_too_short(seed: int) -> None:
    for shift in (1.4, 1.0):
        assert SHORT not in found(logged(seed, 24, np.arange(5, 19), shift)).sentence()
