"""The evidence in a report: every number against a simulation or a fit of its own."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from rga.diagnosis.checks.detectability import least_seen
from rga.diagnosis.checks.leave_one_out import contrast, hold, unseen_groups
from rga.diagnosis.checks.profiles import onset_profile, profiles
from rga.diagnosis.member_forces import member_forces
from rga.diagnosis.residuals.patterns import known_contexts, leftovers
from rga.diagnosis.search.laplace import extended
from rga.findings import Findings
from rga.model import Effect, Model, read_model
from rga.model.effect import seconds
from rga.records import Record
from rga.report import write_report
from rga.report.pages.evidence import _difference
from rga.report.text.actions import BY_VERDICT, actions
from rga.simulation import Simulator

HOSTILE = "<script>alert('x')</script> {place} $\\frac{a_b}$ & \"q\""
PANELS, ROWS, STEP = 6, 250, 3600.0
STIFFNESS = 3e7
SPRING: dict[str, Any] = {
    "kind": "support_spring",
    "support": HOSTILE,
    "dof": "ux",
    "stiffness": STIFFNESS,
}
SETTLEMENT: dict[str, Any] = {
    "kind": "support_settlement",
    "support": HOSTILE,
    "dof": "uz",
    "onset": 500000.0,
}
NOISE = {"displacement": 0.05, "strain": 1.0}


def bridge() -> Model:
    """A plane truss with a hostile support name, two loads and a temperature."""
    low, high = ([f"{side}{i}" for i in range(PANELS + 1)] for side in "LU")
    nodes = {name: [6.0 * i, 0.0, 0.0] for i, name in enumerate(low)}
    nodes |= {name: [6.0 * i, 0.0, 7.0] for i, name in enumerate(high)}
    bars = {f"{a}-{b}": ([a, b], "bottom chord") for a, b in pairwise(low)}
    bars |= {f"{a}-{b}": ([a, b], "top chord") for a, b in pairwise(high)}
    bars |= {f"{a}-{b}": ([a, b], "diagonal") for a, b in zip(low, high[1:], strict=False)}
    bars |= {f"{a}-{b}": ([a, b], "vertical") for a, b in zip(low, high, strict=True)}
    sensors: dict[str, Any] = {
        f"D{i}": {"kind": "displacement", "node": low[i], "direction": [0, 0, 1], "unit": "mm"}
        for i in range(1, PANELS)
    }
    gauged = [f"{a}-{b}" for a, b in pairwise(low)][1:5]
    gauged += [f"{a}-{b}" for a, b in zip(low, high[1:], strict=False)][:3]
    for member in gauged:
        sensors[f"E {member}"] = {"kind": "strain", "member": member, "unit": "microstrain"}
    half = PANELS // 2

    def load(names: list[str], by: str) -> dict[str, Any]:
        forces = {name: [0.0, 0.0, -1e5] for name in names}
        return {"kind": "nodal_load", "forces": forces, "factor": {"context": by}}

    temperature = {"context": "temperature", "minus": 15.0}
    groups = dict.fromkeys(("bottom chord", "top chord", "diagonal", "vertical"), 1.0)
    return read_model(
        {
            "rga_model": 1,
            "name": HOSTILE,
            "plane": "xz",
            "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
            "sections": {"bar": {"A": 0.01}},
            "nodes": nodes,
            "members": {
                name: {"nodes": ends, "section": "bar", "material": "steel", "groups": [group]}
                for name, (ends, group) in bars.items()
            },
            "supports": {
                "west": {"node": low[0], "fixed": ["ux", "uz"]},
                HOSTILE: {"node": low[-1], "fixed": ["uz"]},
            },
            "context": {
                "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.1},
                "left": {"unit": "-", "range": [0, 1], "noise": 0.002},
                "right": {"unit": "-", "range": [0, 1], "noise": 0.002},
            },
            "effects": {
                "warmth": {"kind": "temperature", "groups": groups, "delta": temperature},
                "left half": load(low[1 : half + 1], "left"),
                "right half": load(low[half + 1 : -1], "right"),
            },
            "sensors": sensors,
        },
        "test",
    )


def measured(
    model: Model, hidden: dict[str, Any] | None = None, beside: np.ndarray[Any, Any] | None = None
) -> Record:
    """A record of the model with an effect hidden, and readings beside what any effect gives."""
    random = np.random.default_rng(5)
    time = (np.arange(ROWS) * STEP).astype(np.float64)
    contexts = {
        "temperature": 15 + 12 * np.sin(time / 13000) + random.normal(0, 1, ROWS),
        "left": random.uniform(0, 1, ROWS),
        "right": random.uniform(0, 1, ROWS),
    }
    effects = {} if hidden is None else {"hidden": Effect.vocabulary[hidden["kind"]](**hidden)}
    readings = Simulator(model.extended(effects)).predict({"time": time, **contexts})
    sigma = np.array([NOISE[sensor.kind] for sensor in model.sensors.values()])
    readings = readings + sigma * random.standard_normal(readings.shape)
    if beside is not None:
        readings = readings + sigma * beside
    noise = {"temperature": 0.1, "left": 0.002, "right": 0.002}
    seen = {n: c + random.normal(0, noise[n], ROWS) for n, c in contexts.items()}
    return Record(time, 0.0, "seconds", tuple(model.sensors), readings, seen)


def page(findings: Findings, directory: Path) -> str:
    return write_report(findings, directory / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def restrained() -> Findings:
    """A bearing that is frozen."""
    model = bridge()
    return rga.diagnose(model, measured(model, SPRING))


@pytest.fixture(scope="module")
def settled() -> Findings:
    """A support that settles on the way."""
    model = bridge()
    return rga.diagnose(model, measured(model, SETTLEMENT | {"displacement": -0.002}))


@pytest.fixture(scope="module")
def nothing() -> Findings:
    """The null twin of all cases."""
    model = bridge()
    return rga.diagnose(model, measured(model))


@pytest.fixture(scope="module")
def pattern() -> tuple[Findings, np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Sensors that move together as nothing known can make them, and the rate of the temperature.

    Returns:
        The findings, the direction over the sensors in units of their noise, and the amplitude.
    """
    model = bridge()
    record = measured(model)
    rate = np.cos(record.time / 13000)
    direction = np.random.default_rng(2).normal(0, 2.0, len(model.sensors))
    amplitude = rate + np.random.default_rng(3).normal(0, 0.3, ROWS)
    found = rga.diagnose(model, measured(model, beside=amplitude[:, None] * direction))
    return found, direction, amplitude


def test_the_profile_peaks_at_the_estimate(restrained: Findings) -> None:
    (cause,) = restrained.causes
    found = restrained.account.found
    assert found is not None
    (profile,) = profiles(found, 0)
    middle = len(profile.values) // 2
    assert profile.values[middle] == pytest.approx(cause.effect["stiffness"]["value"])
    assert profile.height[middle] == 0
    assert (np.delete(profile.height, middle) < 0).all()
    # Another value of the parameter, fitted by hand, has the probability that the profile states.
    z = found.fit.z + profile.away[-1] / np.sqrt(found.fit.information[0, 0])
    problem, losses = found.problem, []
    for at in (z, found.fit.z):
        simulated = extended(found.base, found.fit.hypotheses, at).predict(
            problem.data.belief.table
        )
        reduced = problem.covariance.reduce(problem.residual(simulated).T[None])
        losses.append(float(problem.covariance.squares(reduced)[0] + at @ at))
    assert profile.height[-1] == pytest.approx((losses[1] - losses[0]) / 2, rel=1e-3)
    # The record is long: the profile is a parabola whose 90 % interval holds the truth.
    np.testing.assert_allclose(profile.height, -(profile.away**2) / 2, atol=0.35)
    low, high = cause.effect["stiffness"]["ci90"]
    assert low < STIFFNESS < high


def test_the_onset_is_where_the_support_settled(settled: Findings, restrained: Findings) -> None:
    (cause,) = settled.causes
    account = settled.account
    assert account.found is not None
    onset = onset_profile(account.found, 0, account.record.origin)
    assert onset is not None
    assert onset.chances.sum() == pytest.approx(1)
    assert onset.times[np.argmax(onset.chances)] == cause.onset
    assert cause.onset is not None
    assert abs(seconds(cause.onset) - seconds(SETTLEMENT["onset"])) <= 10 * STEP
    assert restrained.account.found is not None
    assert onset_profile(restrained.account.found, 0, 0.0) is None


def test_forces_are_those_of_a_direct_simulation(restrained: Findings) -> None:
    account = restrained.account
    forces = member_forces(account)
    assert forces is not None
    gauges = {f"N {m}": {"kind": "force", "member": m, "unit": "kN"} for m in forces.members}
    model = read_model(
        bridge().model_dump(mode="json", exclude_none=True) | {"sensors": gauges}, "test"
    )
    (cause,) = restrained.causes
    spring = Effect.vocabulary["support_spring"](**cause.effect)
    given, extended = (
        Simulator(one).predict(account.contexts)
        for one in (model, model.extended({"frozen": spring}))
    )
    np.testing.assert_allclose(forces.given, 1e3 * given[forces.row], atol=1e-3)
    np.testing.assert_allclose(forces.extended, 1e3 * extended[forces.row], atol=1e-3)
    known = np.isfinite(forces.ratio)
    ratio = np.sqrt((extended**2).mean(0)[known] / (given**2).mean(0)[known])
    np.testing.assert_allclose(forces.ratio[known], ratio, rtol=1e-9)
    # Of a truss on two supports a horizontal restraint reaches the bottom chord alone.
    chord = np.array([name.startswith("L") and "-L" in name for name in forces.members])
    np.testing.assert_allclose(forces.ratio[known & ~chord], 1, atol=1e-6)
    assert (np.abs(forces.ratio[known & chord] - 1) > 0.02).all()
    # Beside the roller the chord carries nothing until the bearing freezes.
    last = forces.members.index(f"L{PANELS - 1}-L{PANELS}")
    assert forces.ratio[last] == np.inf
    assert forces.changed[last] == pytest.approx(1e3 * np.sqrt((extended[:, last] ** 2).mean()))
    assert forces.amplitude[last] < 1e-6
    assert forces.row == np.argmax((given**2 * np.array([length(model, m) for m in gauges])).sum(1))


def length(model: Model, gauge: str) -> float:
    member = model.members[str(model.sensors[gauge].member)]
    first, last = (np.array(model.nodes[node]) for node in member.nodes)
    return float(np.linalg.norm(last - first))


def test_a_bearings_restraint_is_not_credited(
    restrained: Findings, settled: Findings, tmp_path: Path
) -> None:
    forces = member_forces(restrained.account)
    assert forces is not None
    assert forces.credited is not None
    known = np.isfinite(forces.ratio)
    np.testing.assert_allclose(forces.credited[known], 1)
    # A settlement moves a truss on two supports without straining it.
    still = member_forces(settled.account)
    assert still is not None
    assert still.credited is None
    assert "normally not credited" not in page(settled, tmp_path)


def test_gauges_measure_the_force_of_the_extended_model(restrained: Findings) -> None:
    account = restrained.account
    forces = member_forces(account)
    assert forces is not None
    gauged = np.isfinite(forces.measured)
    names = {account.model.sensors[name].member for name in account.record.sensors} - {None}
    assert {forces.members[k] for k in np.flatnonzero(gauged)} == names
    np.testing.assert_allclose(forces.measured[gauged], forces.ratio[gauged], rtol=0.05)
    # Strain times EA over the calculated force, by hand.
    name = next(n for n in account.record.sensors if n.startswith("E L2"))
    column, member = account.record.sensors.index(name), account.model.sensors[name].member
    strain = account.record.readings[:, column]
    strain = strain[np.isfinite(strain)] * 1e-6
    k = forces.members.index(str(member))
    by_hand = np.sqrt((strain**2).mean()) * 2e11 * 0.01 / forces.amplitude[k]
    assert forces.measured[k] == pytest.approx(by_hand, rel=0.03)


def test_a_group_left_out_was_not_looked_at(restrained: Findings) -> None:
    found = restrained.account.found
    assert found is not None
    groups = {one.group: one for one in unseen_groups(found)}
    chord = groups["strain bottom chord"]
    assert chord.gap_with < 0.2 * chord.gap_without
    assert np.nanmean((chord.measured - chord.with_causes) ** 2) < 0.2 * np.nanmean(
        (chord.measured - chord.without) ** 2
    )
    readings = found.problem.data.readings.copy()
    readings[:, [found.problem.data.sensors.index(name) for name in chord.channels]] *= 3
    other = replace(
        found, problem=replace(found.problem, data=replace(found.problem.data, readings=readings))
    )
    again = {one.group: one for one in unseen_groups(other)}["strain bottom chord"]
    np.testing.assert_allclose(again.with_causes, chord.with_causes, rtol=1e-9, atol=1e-9)
    assert again.gap_with > 10 * chord.gap_with


def test_the_rival_is_the_nearest_alternative(restrained: Findings) -> None:
    found = restrained.account.found
    assert found is not None
    shown = contrast(found, 0)
    assert shown is not None
    behind = [found.fit.log_evidence - one.fit.log_evidence for one in found.alternatives[0]]
    assert shown.lead == pytest.approx(min(behind))
    columns = [found.problem.data.sensors.index(name) for name in shown.channels]
    residual = found.problem.whole_residual(found.fit.simulated)[:, columns]
    np.testing.assert_allclose(shown.measured - shown.predicted, residual, atol=1e-9)
    assert list(shown.size) == sorted(shown.size, reverse=True)
    much, little = (replace(shown, size=share * shown.size / shown.size[0]) for share in (16, 2))
    assert _difference(much) == f"They differ most on {shown.channels[0]}, by 16"
    assert _difference(little) == "On no channel do they differ by more than 2.0"


def test_what_hangs_on_a_channel_is_what_is_left_without_it(restrained: Findings) -> None:
    found = restrained.account.found
    assert found is not None
    held = hold(found, 0)
    shown = contrast(found, 0)
    assert held is not None
    assert shown is not None
    assert held.left < min(restrained.causes[0].log_odds, shown.lead)
    assert held.channel in restrained.account.record.sensors


@pytest.mark.parametrize(("times", "seen"), [(0.5, False), (2.0, True)])
def test_the_least_effect_is_where_it_is_no_longer_named(
    restrained: Findings, times: float, seen: bool
) -> None:
    found = restrained.account.found
    assert found is not None
    least = least_seen(found, 0)
    assert least is not None
    assert least.value is not None
    assert 0 < least.value < STIFFNESS
    model = bridge()
    findings = rga.diagnose(model, measured(model, SPRING | {"stiffness": times * least.value}))
    assert ("support_spring" in {cause.effect["kind"] for cause in findings.causes}) is seen


def test_the_pattern_that_is_left_is_drawn_with_what_it_follows(
    pattern: tuple[Findings, np.ndarray[Any, Any], np.ndarray[Any, Any]], tmp_path: Path
) -> None:
    findings, direction, amplitude = pattern
    assert findings.verdict in ("unknown", "partial")
    account = findings.account
    assert account.found is not None
    problem = account.found.problem
    found = leftovers(problem, known_contexts(problem, set(account.record.contexts)))
    first = found[0]
    assert abs(np.corrcoef(first.pattern, direction)[0, 1]) > 0.9
    rows = np.round(problem.data.time / STEP).astype(int)
    assert abs(np.corrcoef(first.amplitude, amplitude[rows])[0, 1]) > 0.9
    assert "the rate of temperature" in first.follows
    assert next(iter(first.drivers)) == "temperature"
    html = page(findings, tmp_path)
    assert "it is strongest at" in html
    assert "move together from row to row" in html


def test_the_null_record_calls_for_nothing(nothing: Findings, tmp_path: Path) -> None:
    assert nothing.verdict == "nothing_wrong"
    html = page(nothing, tmp_path)
    assert BY_VERDICT["nothing_wrong"] in html
    for words in (
        'class="card"',
        "What would change this",
        "What it means for the members",
        "Channels left out and predicted",
        "it is strongest at",
        "<dt>inspect</dt>",
    ):
        assert words not in html
    assert member_forces(nothing.account) is None


def test_a_cause_is_shown_with_all_its_evidence(restrained: Findings, tmp_path: Path) -> None:
    html = page(restrained, tmp_path)
    assert "<script" not in html
    for words in (
        "What would change this",
        "Its lead hangs most on channel",
        "would not have been named",
        "What it means for the members",
        "Channels left out and predicted",
        "<dt>inspect</dt>",
        "Against its nearest rival",
        "normally not credited",
    ):
        assert words in html
    assert html == page(restrained, tmp_path)


def test_every_kind_calls_for_something() -> None:
    general = {k for k, kind in Effect.vocabulary.items() if kind.action is Effect.action}
    assert general == {"temperature", "nodal_load", "member_load", "axle_load"}
    for kind in Effect.vocabulary:
        for word, said in actions({"kind": kind}):
            assert word in ("inspect", "check", "test")
            assert "{" not in said
    assert HOSTILE in dict(actions(SPRING))["inspect"]
    assert actions({"kind": "of my own"})
