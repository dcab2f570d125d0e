"""A long past of which few rows can be analysed: a late change beside its null twin.

The past is that of a truss in plain NumPy (site_truss), members and gauges off as on any site, with
noise that remembers from row to row. The rows are chosen as the twin chooses them.
"""

from functools import cache

import numpy as np
import pytest
from scipy.signal import lfilter

from findings_invariants import check_invariants
from rga import Findings, diagnose
from rga.findings.criteria import Criteria
from rga.records import Record
from rga.twin.history import Event
from rga.twin.past.chosen_past import chosen_past, with_choice
from site_truss import MEMBERS, NOISE, SPREAD, Array, Logged, Site, model

#: rows of the past, of which a diagnosis analyses so many; seconds from row to row
LONG, MOST, EVERY = 20_000, 400, 600.0
#: end of the calibration, and rows from the change to the alarm
CALIBRATED, LATER = 200, 7
SOFTER, FACTOR, MEMORY = "L2-L3", 0.75, 0.9
CRITERIA = Criteria.model_validate({"record": {"most_rows": MOST}})
cases = pytest.mark.parametrize(("seed", "begun"), [(2, 19_000), (3, 19_900)])


def wandering(draw: np.random.Generator, memory: float) -> Array:
    innovations = np.sqrt(1 - memory**2) * draw.standard_normal(LONG)
    return np.asarray(lfilter([1.0], [1.0, -memory], innovations))


def read(area: dict[str, float], contexts: dict[str, Array], built: Array) -> dict[str, Array]:
    rows = len(contexts["temperature"])
    as_modelled = {"roller": np.zeros(rows), "sinks": np.zeros(rows)}
    site = Site(area=area, stretched=np.zeros((rows, len(MEMBERS))), **as_modelled)
    return site.readings(contexts, built)


@cache
def past(seed: int, factor: float, begun: int) -> Record:
    """Twenty weeks; from a row on a member is softer by a factor (1: the null twin)."""
    draw, time = np.random.default_rng(seed), EVERY * np.arange(LONG)
    seasons = 8 * np.sin(2 * np.pi * time / time[-1]) + 5 * np.sin(2 * np.pi * time / 86400)
    contexts = {"temperature": 10 + seasons + 1.5 * wandering(draw, 0.99)}
    for load in ("west load", "east load"):
        contexts[load] = np.clip(40 + 15 * wandering(draw, 0.9), 0, 100)
    built = np.exp(0.01 * draw.standard_normal(len(MEMBERS)))
    before = read({}, {name: one[:begun] for name, one in contexts.items()}, built)
    since = read({SOFTER: factor}, {name: one[begun:] for name, one in contexts.items()}, built)
    readings = {}
    for name in before:
        noise = NOISE["microstrain" if name.startswith("S ") else "mm"] * wandering(draw, MEMORY)
        gain = 1 + 0.005 * draw.standard_normal()
        readings[name] = gain * np.concatenate([before[name], since[name]]) + noise
    told = {name: one + SPREAD[name] * draw.standard_normal(LONG) for name, one in contexts.items()}
    return Logged(time, readings, told).record()


def of_chosen_rows(seed: int, factor: float, begun: int) -> Findings:
    row = begun + LATER
    alarm = Event("alarm", row, EVERY * row, "what the channels read has changed")
    whole = past(seed, factor, begun)
    choice = chosen_past(model(), whole, [alarm], CALIBRATED, MOST, seed=0)
    assert len(choice.rows) <= MOST
    found = diagnose(model(), whole.rows(choice.rows), criteria=CRITERIA)
    findings = with_choice(found, [choice.words], LONG)
    check_invariants(findings)
    return findings


@cases
def test_a_change_near_the_end_is_found_and_dated_to_a_few_rows(seed: int, begun: int) -> None:
    findings = of_chosen_rows(seed, FACTOR, begun)
    (cause,) = findings.causes
    assert (cause.effect["kind"], cause.effect["member"]) == ("member_stiffness", SOFTER)
    assert cause.effect["factor"]["value"] == pytest.approx(FACTOR, abs=0.02)
    # A block of rows that is held out has eight of them.
    assert cause.onset == pytest.approx(EVERY * begun, abs=8 * EVERY)
    assert findings.account.recorded == LONG
    assert "of 20 000 rows, 4 on end: " in findings.warnings[-1]
    assert f"about rows 200, {begun // 1000} {begun % 1000 + LATER:03}, " in findings.warnings[-1]


@cases
def test_nothing_is_found_where_nothing_has_changed(seed: int, begun: int) -> None:
    findings = of_chosen_rows(seed, 1.0, begun)
    assert (findings.verdict, findings.causes) == ("nothing_wrong", [])


def test_evenly_chosen_rows_do_not_show_it() -> None:
    """Why rows are chosen at all: two of those that are evenly chosen lie behind the change."""
    assert diagnose(model(), past(3, FACTOR, 19_900), criteria=CRITERIA).causes == []
