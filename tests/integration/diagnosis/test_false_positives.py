"""Traps of a diagnosis: a record in which stepping into each of them would lead to a false name.

Most are null records, in which nothing is hidden: what a careless diagnosis makes of chance,
memory, scatter, errors of the contexts or dynamics shows there as a cause. The readings come from
physics of their own (rga_bench.synthetic).
"""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga import Findings, diagnose, load_model, load_record
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.model import read_model
from rga_bench.synthetic import Case, Conditions, draw_case
from rga_bench.synthetic.gauges import observe
from rga_bench.synthetic.noise import autoregressive
from rga_bench.synthetic.physics.world import World

Diagnosed = Callable[[Case], Findings]
#: standard deviations of the noise that are no chance
FAR = 8.0


def drawn(seed: int, kind: str = "null", rows: int = 100, **conditions: Any) -> Case:
    """A case of the footbridge."""
    return draw_case(
        seed,
        bridge="footbridge",
        kind=kind,
        reality="truss",
        rows=rows,
        conditions=Conditions(**conditions),
        aims=(20.0, 40.0),
    )


def nothing_found(findings: Findings) -> bool:
    return not findings.causes and findings.verdict == "nothing_wrong"


# --- Rows that no step sees -----------------------------------------------------------------------


def with_other_held_out_readings(case: Case, findings: Findings) -> Case:
    """The case with every reading of the held-out rows far off."""
    account = findings.account
    far = dict(zip(account.record.sensors, FAR * account.sigma, strict=True))
    channels = {
        name: column + account.held_out * far.get(name, 0.0)
        for name, column in case.channels.items()
    }
    return replace(case, channels=channels)


def fitted(findings: Findings) -> dict[str, Any]:
    """What findings say of the rows that are not held out."""
    return findings.model_dump(include={"unidentifiable", "explanations", "contexts"})


def test_no_fit_sees_held_out_readings(diagnosed: Diagnosed) -> None:
    case = drawn(1, rows=80, scatter=0.03)
    findings = diagnosed(case)
    others = diagnosed(with_other_held_out_readings(case, findings))
    assert nothing_found(findings)
    assert fitted(others) == fitted(findings)
    assert others.gap.held_out.after > findings.gap.held_out.after + FAR**2 / 2
    # What the fit does not see the verdict does.
    assert others.verdict == "unknown"
    assert others.causes == []


def with_other_held_out_response(case: Case, findings: Findings) -> Case:
    """The case with held-out readings that the model as it was given explains."""
    account = findings.account
    as_given = dict(zip(account.record.sensors, account.before.T, strict=True))
    channels = {
        name: np.where(account.held_out, as_given[name], column) if name in as_given else column
        for name, column in case.channels.items()
    }
    return replace(case, channels=channels)


def test_no_cause_stands_against_held_out_readings(diagnosed: Diagnosed) -> None:
    case = drawn(1, "load_scale", rows=80, scatter=0.03)
    findings = diagnosed(case)
    assert [cause.effect["kind"] for cause in findings.causes] == ["load_scale"]
    assert findings.gap.held_out.gain_ci90[0] > 0
    others = diagnosed(with_other_held_out_response(case, findings))
    assert others.verdict == "unknown"
    assert others.causes == []
    assert "load scale" in others.unexplained.looks_like
    assert others.account.extended.effects == others.account.model.effects


# --- The number of hypotheses ---------------------------------------------------------------------


def all_hypotheses(case: Case) -> list[Hypothesis]:
    model = read_model(case.model, "case")
    return hypotheses(model, list(model.sensors), list(model.context))


def test_the_prior_is_shared_by_kinds_places_moments_and_profiles() -> None:
    several = all_hypotheses(drawn(0, rows=20))
    always = np.exp([one.log_prior for one in several])
    assert always.sum() == pytest.approx(0.5)
    kinds = {one.name for one in several}
    for kind in kinds:
        own = [prior for one, prior in zip(several, always, strict=True) if one.name == kind]
        assert sum(own) == pytest.approx(0.5 / len(kinds))
    late = np.exp([one.beginning(3600.0).log_prior for one in several])
    # An onset may lie at any of many moments, and each of them may begin a jump or a ramp.
    assert (2 * 10 * late < always).all()


def test_chance_finds_no_cause_among_many(diagnosed: Diagnosed) -> None:
    """A slip of one of many members at one of many moments, likelier than nothing by exp(12)."""
    assert nothing_found(diagnosed(drawn(122, rows=60)))


# --- Noise with memory ----------------------------------------------------------------------------


def with_memory(case: Case, phi: float) -> Case:
    """The case with noise of its own: AR(1) with correlation phi from row to row."""
    assert case.beyond is not None
    sensors = case.model["sensors"]
    deviation = np.array([sensor["noise"] for sensor in sensors.values()])
    rows = len(case.time)
    noise = autoregressive(np.random.default_rng(1), rows, deviation, np.full(len(deviation), phi))
    readings = dict(zip(sensors, (case.beyond.clean[:rows] + noise).T, strict=True))
    return replace(case, channels={**case.channels, **readings})


def test_noise_that_wanders_is_no_cause(diagnosed: Diagnosed) -> None:
    case = drawn(1, rows=150, scatter=0.01, contexts="known", later=1)
    assert nothing_found(diagnosed(with_memory(case, 0.9)))


# --- Errors of the contexts -----------------------------------------------------------------------


def test_errors_of_the_contexts_are_no_cause_and_no_structure(diagnosed: Diagnosed) -> None:
    assert nothing_found(diagnosed(drawn(1)))


# --- Scatter, and what gains on rows that no step saw ---------------------------------------------


@pytest.fixture(scope="module")
def scattered(diagnosed: Diagnosed) -> Findings:
    """Of a record with nothing hidden, its members and gains off by 3 % and 1.5 %."""
    return diagnosed(drawn(0, scatter=0.03))


def test_scatter_is_no_cause(scattered: Findings) -> None:
    assert nothing_found(scattered)


def test_a_gain_on_held_out_rows_is_no_cause(scattered: Findings) -> None:
    """The gain of a channel, fitted to the other rows, is closer in every block held out."""
    account = scattered.account
    measured, simulated, unseen = account.record.readings, account.before, account.held_out
    seen = np.isfinite(measured)
    fitted = seen & ~unseen[:, None]
    product = np.where(fitted, measured * simulated, 0.0).sum(0)
    factor = product / np.where(fitted, simulated**2, 0.0).sum(0)
    off = (measured - simulated) ** 2 - (measured - factor * simulated) ** 2
    gains = np.where(seen, off / account.noise**2, 0.0)
    number = int(np.argmax(gains[~unseen].sum(0)))
    blocks = np.split(
        gains[unseen, number], np.flatnonzero(np.diff(np.flatnonzero(unseen)) > 1) + 1
    )
    sums = np.array([block.sum() for block in blocks])
    assert len(blocks) >= 10
    assert sums.mean() > 2 * sums.std(ddof=1) / np.sqrt(len(blocks))
    assert np.concatenate(blocks).sum() > FAR**2 / 2
    assert nothing_found(scattered)


# --- Parameters with one side ---------------------------------------------------------------------


#: parameters that have a meaning above zero alone; a gain may have the wrong sign
ABOVE_ZERO = {"stiffness", "factor", "area", "connector_stiffness", "mu", "permanent_force"}
ABOVE_ZERO |= {"slip", "gap", "length", "time_constant"}


def above_zero(kind: str, parameter: str) -> bool:
    return parameter in ABOVE_ZERO and kind != "sensor_gain"


def test_no_fit_leaves_the_range_of_a_parameter() -> None:
    """However far a fit goes, what it tries is an effect, and all its parameters have a meaning."""
    far = (-FAR, -3.0, 0.0, 3.0, FAR)
    bounded = set()
    for one in all_hypotheses(drawn(0, rows=20)):
        for z in far:
            one.effect([z] * len(one.priors))  # refuses what no model may state
        for name, prior in one.priors.items():
            values = [prior.value(z) for z in far]
            assert values == sorted(set(values))
            if above_zero(one.name, name):
                bounded.add(name)
                assert values[0] > 0
    assert bounded == ABOVE_ZERO


def test_a_loss_of_stiffness_is_no_area_below_zero(diagnosed: Diagnosed) -> None:
    case = drawn(3, "member_stiffness", scatter=0.01)
    assert case.truth["place"] == {"group": "rail chord"}
    assert case.truth["value"] < 0.8
    findings = diagnosed(case)
    (cause,) = findings.causes
    assert (cause.effect["kind"], cause.effect["group"]) == ("member_stiffness", "rail chord")
    assert cause.effect["factor"]["ci90"][1] < 1
    tried = [effect for one in findings.explanations for effect in one.effects]
    for effect in [cause.effect, *cause.rivals, *tried]:
        for name, value in effect.items():
            if above_zero(effect["kind"], name):
                assert 0 < value["ci90"][0] <= value["value"] <= value["ci90"][1]


# --- Moving loads ---------------------------------------------------------------------------------

SPEED, LENGTH, BASE = 1.5, 12.0, 2.0


@pytest.fixture(scope="module")
def crossed(
    small_bridge: dict[str, Any], tmp_path_factory: pytest.TempPathFactory
) -> Callable[[bool], Findings]:
    """The diagnosis of a crossing that makes the small bridge swing, with a thin bar or without."""

    def crossing(thin: bool) -> Findings:
        content = json.loads(json.dumps(small_bridge))
        content["materials"]["steel"] |= {"nu": 0.3, "density": 7850}
        content["sections"]["bar"] |= {"Iy": 1e-6, "Iz": 1e-6, "J": 1e-6}
        for member in content["members"].values():
            member["kind"] = "truss"
        content["context"] = {
            "weight": {"unit": "-", "range": [0, 1], "noise": 1e-6},
            "cart": {"unit": "m", "range": [-5, 17], "law": "linear", "rate": [0.5, 4.0]},
        }
        content["effects"] = {
            "axles": {
                "kind": "axle_load",
                "path": [f"L{i}" for i in range(5)],
                "forces": [1e5, 1e5],
                "offsets": [0.0, BASE],
                "factor": {"context": "weight"},
                "position": {"context": "cart"},
            }
        }
        draw = np.random.default_rng(7)
        world = World.of(content)
        factor = np.exp(0.02 * draw.standard_normal(len(content["members"])))
        factor[list(content["members"]).index("U1-L2")] *= 0.2 if thin else 1.0
        world.scale_stiffness(factor)
        rows = 160
        time = np.linspace(0.0, (LENGTH + BASE) / SPEED, rows)
        contexts = {"weight": np.ones(rows), "cart": SPEED * time}
        # The first mode, driven by a rough track: noise that rings, in the shape of a deflection.
        static = observe(world, contexts, time)
        shape = observe(world, {"weight": np.ones(1), "cart": np.array([7.0])}, np.zeros(1))[0]
        turn = 2 * np.pi * 0.6 * (time[1] - time[0])
        swing = np.zeros(rows)
        for row in range(2, rows):
            again = 2 * 0.99 * np.cos(turn) * swing[row - 1] - 0.99**2 * swing[row - 2]
            swing[row] = again + draw.standard_normal()
        readings = static + 0.15 * (swing / swing.std())[:, None] * shape
        noise = np.array([sensor["noise"] for sensor in content["sensors"].values()])
        readings += noise * draw.standard_normal(readings.shape)
        folder = tmp_path_factory.mktemp("crossing")
        columns = {"time": time, "weight": contexts["weight"]}
        columns |= dict(zip(content["sensors"], readings.T, strict=True))
        pl.DataFrame(columns).write_csv(folder / "record.csv")
        (folder / "model.json").write_text(json.dumps(content), encoding="utf-8")
        model = load_model(folder / "model.json")
        return diagnose(model, load_record(folder / "record.csv", model))

    return crossing


def test_what_swings_under_a_moving_load_is_no_cause(crossed: Callable[[bool], Findings]) -> None:
    findings = crossed(False)
    assert findings.causes == []
    assert findings.verdict == "unknown"
    assert findings.unexplained.share > 0.2


def test_a_thin_bar_is_named_beside_what_swings(crossed: Callable[[bool], Findings]) -> None:
    (cause,) = crossed(True).causes
    assert (cause.effect["kind"], cause.effect["member"]) == ("member_stiffness", "U1-L2")
    low, high = cause.effect["factor"]["ci90"]
    assert low - 0.1 < 0.2 < high + 0.1


# --- Outliers -------------------------------------------------------------------------------------


def test_an_outlier_in_the_last_row_is_no_onset(diagnosed: Diagnosed) -> None:
    case = drawn(0, scatter=0.01)
    channel = case.channels["w3"].copy()
    channel[-1] += 14 * case.model["sensors"]["w3"]["noise"]
    assert nothing_found(diagnosed(replace(case, channels={**case.channels, "w3": channel})))
