"""Contexts as sites give them: noisy, at the limit of their instrument, wrong for a moment.

Each record stands beside its twin with nothing hidden, or with a sound context.
"""

from dataclasses import replace

import numpy as np
import pytest

from findings_invariants import check_invariants
from rga import Findings, Model, diagnose
from rga.model import read_model
from site_truss import ROWS, Logged, Site, content, logged, model

#: standard deviation of what measures the loads [kN]: a deflection errs by more than by its noise
COARSE = 4.0
BEGUN = np.arange(ROWS) >= 72
seeds = pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.thorough)])


def coarse_model() -> Model:
    stated = content()
    for load in ("west load", "east load"):
        stated["context"][load]["noise"] = COARSE
    return read_model(stated, "site")


def coarse(seed: int) -> Logged:
    log = logged(Site(), seed)
    draw = np.random.default_rng(100 + seed)
    loads = ("west load", "east load")
    noisy = {load: log.contexts[load] + COARSE * draw.standard_normal(ROWS) for load in loads}
    return replace(log, contexts={**log.contexts, **noisy})


def found(structure: Model, log: Logged) -> Findings:
    findings = diagnose(structure, log.record())
    check_invariants(findings)
    return findings


@seeds
def test_a_late_bias_is_found_beside_errors_that_many_channels_share(seed: int) -> None:
    log = coarse(seed)
    shift = 0.4 * BEGUN
    biased = replace(log, readings={**log.readings, "D4": log.readings["D4"] + shift})
    findings = found(coarse_model(), biased)
    (effect,) = [cause.effect for cause in findings.causes]
    assert (effect["kind"], effect["sensor"]) == ("sensor_bias", "D4")
    assert effect["offset"]["value"] == pytest.approx(0.4, abs=0.05)
    assert found(coarse_model(), log).verdict == "nothing_wrong"


@seeds
def test_rows_at_the_limit_of_an_instrument_name_nothing(seed: int) -> None:
    log = logged(Site(), seed)
    top = np.sort(log.contexts["west load"])[-4:]
    peak = np.argsort(log.contexts["west load"])[-4:]
    gust = log.contexts["west load"].copy()
    # Neighbours in time, as a gust has them.
    rows = np.arange(60, 64)
    gust[rows], gust[peak] = top, gust[rows]
    order = np.arange(ROWS)
    order[rows], order[peak] = peak, rows
    moved = replace(
        log,
        readings={name: column[order] for name, column in log.readings.items()},
        contexts={name: column[order] for name, column in log.contexts.items()},
    )
    limit = float(np.sort(moved.contexts["west load"])[-5:-3].mean())
    clipped = np.minimum(moved.contexts["west load"], limit)
    findings = found(model(), replace(moved, contexts={**moved.contexts, "west load": clipped}))
    assert findings.verdict == "nothing_wrong"
    assert any("at its limit" in one for one in findings.warnings)
    twin = found(model(), moved)
    assert twin.verdict == "nothing_wrong"
    assert not any("at its limit" in one for one in twin.warnings)


@seeds
def test_a_context_that_is_wrong_for_a_moment_names_nothing(seed: int) -> None:
    log = logged(Site(), seed)
    wild = log.contexts["east load"].copy()
    wild[[20, 90]] = [95.0, 99.0]
    findings = found(model(), replace(log, contexts={**log.contexts, "east load": wild}))
    assert findings.verdict == "nothing_wrong"
    assert any("many channels jump at once" in one for one in findings.warnings)
    twin = found(model(), log)
    assert not any("many channels jump at once" in one for one in twin.warnings)


def zeroed(log: Logged) -> Findings:
    """Findings of a record whose channels were set to zero each by itself, over its first rows."""
    own = {name: column - np.nanmean(column[:12]) for name, column in log.readings.items()}
    span = float(log.time[0]), float(log.time[11])
    findings = diagnose(model(), replace(replace(log, readings=own).record(), zero=span))
    check_invariants(findings)
    return findings


@seeds
def test_a_copy_with_a_zero_of_its_own_is_reported(seed: int) -> None:
    log = logged(Site(), seed)
    gap = log.readings["S L2-L3"].copy()
    gap[3] = np.nan
    copy = {**log.readings, "S L2-L3": gap, "S L3-L4": log.readings["S L2-L3"]}
    (fault,) = [one.effect for one in zeroed(replace(log, readings=copy)).causes]
    assert (fault["kind"], fault["mode"]) == ("sensor_fault", "copy")
    assert fault["sensor"] in ("S L2-L3", "S L3-L4")
    assert zeroed(log).verdict == "nothing_wrong"
