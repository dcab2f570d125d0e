"""Rivals of every kind, effects at sensors beside members, and plans that start from the advice."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from findings_invariants import check_invariants
from rga import diagnose, load_findings, plan
from rga.diagnosis.assemble.causes import causes
from rga.diagnosis.assemble.effects import effects_of
from rga.diagnosis.checks.leave_one_out import hold
from rga.diagnosis.member_forces import member_forces
from rga.diagnosis.search.hypothesis import hypotheses
from rga.diagnosis.search.screening import Prospect
from rga.diagnosis.search.stepwise import FITTED, HOPELESS, Alternative, Found, worth_fitting
from rga.errors import InputError
from rga.experiments.defaults import strain_share, usual_truck
from rga.experiments.truck import lane_of
from rga.findings import Findings
from rga.findings.criteria import Criteria
from rga.findings.phrases import effect_words
from rga.model import Effect, Model, read_effect, read_model
from rga.model.schema import Sensor
from rga.planning.rivals import NEAREST, rival_pairs
from rga.records import Record
from rga.twin.simulation_model import mounted

Recorded = Callable[..., Record]
RIVALS = Criteria().rivals
GAUGE, BESIDE = "S L2-L3", "S L0-L1"
OFF_FIBRE = {"kind": "gauge_position", "sensor": GAUGE, "y": 0.0, "z": 0.12}
LOWER = {"kind": "support_settlement", "support": "east", "dof": "uz", "displacement": -0.01}


def framed(content: dict[str, Any]) -> Model:
    """The measured bridge of welded members, gauges on their axes near the joints."""
    section = {**content["sections"]["bar"], "Iy": 1e-4, "Iz": 1e-4, "J": 1e-5}
    members = {name: {**one, "kind": "frame"} for name, one in content["members"].items()}
    material = {**content["materials"]["steel"], "nu": 0.3}
    sensors = {
        name: one | ({"at": 0.02} if one["kind"] == "strain" else {})
        for name, one in content["sensors"].items()
    }
    changed = {"sections": {"bar": section}, "members": members, "materials": {"steel": material}}
    return read_model(content | changed | {"sensors": sensors}, "welded bridge")


@pytest.fixture(scope="module")
def welded(measured_bridge: dict[str, Any]) -> Model:
    return framed(measured_bridge)


@pytest.fixture(scope="module")
def off_fibre(welded: Model, measured_record: Recorded) -> Findings:
    """A gauge that is off its fibre."""
    findings = diagnose(welded, measured_record(welded, OFF_FIBRE))
    check_invariants(findings)
    return findings


def test_a_gauge_off_its_fibre_is_reported(off_fibre: Findings, tmp_path: Path) -> None:
    (cause,) = off_fibre.causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("gauge_position", GAUGE)
    assert member_forces(off_fibre.account) is None
    html = off_fibre.write(tmp_path).read_text(encoding="utf-8")
    assert "could not be drawn" not in html
    assert "What it means for the members" not in html
    # Without its own channel nothing would be left of it, which says nothing.
    found = off_fibre.account.found
    assert found is not None
    hangs = hold(found, 0)
    assert hangs is None or hangs.channel != GAUGE


def test_gauges_at_their_fibres_are_left_alone(
    welded: Model, measured_record: Recorded, tmp_path: Path
) -> None:
    """The null twin of it, its report written too."""
    findings = diagnose(welded, measured_record(welded))
    check_invariants(findings)
    assert findings.verdict == "nothing_wrong"
    assert findings.causes == []
    html = findings.write(tmp_path).read_text(encoding="utf-8")
    assert "could not be drawn" not in html


def test_a_gauge_beside_a_settlement_leaves_its_forces(
    welded: Model, measured_record: Recorded
) -> None:
    given = welded.extended({"off": read_effect(OFF_FIBRE, "off")})
    both = diagnose(given, measured_record(given, LOWER | {"onset": 30000.0}))
    alone = diagnose(welded, measured_record(welded, LOWER | {"onset": 30000.0}))
    forces = [member_forces(one.account) for one in (both, alone)]
    assert [[c.effect["kind"] for c in one.causes] for one in (both, alone)] == [
        ["support_settlement"]
    ] * 2
    assert forces[0] is not None
    assert forces[1] is not None
    np.testing.assert_allclose(forces[0].given, forces[1].given)


@pytest.mark.parametrize("kind", ["gauge_position", "sensor_gain"])
def test_effects_go_with_the_sensor_that_they_name(welded: Model, kind: str) -> None:
    change = {"z": 0.05} if kind == "gauge_position" else {"factor": 1.2}
    effect = read_effect({"kind": kind, "sensor": GAUGE, **change}, "off")
    model = welded.extended({"off": effect})
    assert "off" in mounted(model, (GAUGE, BESIDE)).effects
    assert "off" not in mounted(model, (BESIDE,)).effects
    # Another sensor of the name is not the one that the effect is about.
    other = Sensor(kind="force", member="L2-L3", unit="N")
    assert "off" not in model.with_sensors({GAUGE: other}).effects
    assert model.with_sensors(model.sensors) == model


def test_a_truck_is_chosen_for_a_model_with_effects_at_sensors(welded: Model) -> None:
    model = welded.extended({"off": read_effect(OFF_FIBRE, "off")})
    lane = lane_of(model)
    assert lane is not None
    truck = usual_truck(model, lane)
    assert strain_share(model, lane, truck) == strain_share(welded, lane, truck)


def test_which_effects_are_at_sensors() -> None:
    at_sensors = {kind for kind, one in Effect.vocabulary.items() if one.at_sensors()}
    assert {"gauge_position", "sensor_gain", "sensor_swap", "sensor_fault"} <= at_sensors
    assert not at_sensors & {"member_stiffness", "support_spring", "context_bias", "load_scale"}


@pytest.fixture(scope="module")
def open_kind(measured_bridge: dict[str, Any], measured_record: Recorded) -> Findings:
    """A soft steel under one sensor: much would do as well."""
    one = {"sensors": {"D2": measured_bridge["sensors"]["D2"]}}
    model = read_model(measured_bridge | one, "one sensor")
    soft = {"kind": "elastic_modulus", "material": "steel", "factor": 0.85}
    findings = diagnose(model, measured_record(model, soft))
    check_invariants(findings)
    return findings


def behind(findings: Findings, *distances: float) -> Found:
    """The end of the search, with alternatives at other distances: as many as are given."""
    found = findings.account.found
    assert found is not None
    ((*known,),) = found.alternatives
    placed = [replace(one, behind=by) for one, by in zip(known, distances, strict=False)]
    return replace(found, alternatives=(tuple(placed),))


def kinds(alternatives: list[Alternative]) -> list[str]:
    return [one.hypothesis.name for one in alternatives]


def test_the_nearest_of_each_other_kind_comes_first(open_kind: Findings) -> None:
    (cause,) = open_kind.causes
    assert open_kind.verdict == "ambiguous"
    found = open_kind.account.found
    assert found is not None
    within = sorted(
        (one for one in found.alternatives[0] if one.behind < RIVALS.log_odds),
        key=lambda one: one.behind,
    )
    others = list(dict.fromkeys(name for name in kinds(within) if name != cause.effect["kind"]))
    listed = [rival["kind"] for rival in cause.rivals]
    assert len(others) >= 3
    assert listed[: len(others)] == others
    assert len(listed) == RIVALS.listed < len(within)
    assert cause.rivals_omitted == len(within) - RIVALS.listed


def test_places_come_after_kinds_however_near(open_kind: Findings) -> None:
    record = open_kind.account.record
    known = behind(open_kind, *[9.0] * 20)
    ((*ranked,),) = known.alternatives
    several = next(name for name in kinds(ranked) if kinds(ranked).count(name) >= 3)
    places = [one for one in ranked if one.hypothesis.name == several]
    other = next(
        one for one in ranked if one.hypothesis.name not in (several, known.fit.hypotheses[0].name)
    )

    def listed(*chosen: tuple[Alternative, float]) -> tuple[list[str], int]:
        near = tuple(replace(one, behind=by) for one, by in chosen)
        found = replace(known, alternatives=(near,))
        (cause,) = causes(found, effects_of(found, record), record, [])
        return [rival["kind"] for rival in cause.rivals], cause.rivals_omitted

    last = other.hypothesis.name
    near = [(one, 0.1 * k) for k, one in enumerate(places)]
    assert listed(*near, (other, 4.0)) == ([several, last, *[several] * (len(near) - 1)], 0)
    # What is farther than a hundred to one is no rival, and not counted.
    assert listed(*near, (other, RIVALS.log_odds + 0.1)) == ([several] * len(near), 0)
    assert listed((other, RIVALS.log_odds + 0.1)) == ([], 0)
    many = [(replace(places[0]), 0.1 * k) for k in range(RIVALS.listed + 4)]
    assert listed(*many, (other, 4.0)) == ([several, last, *[several] * (RIVALS.listed - 2)], 5)


def test_omitted_rivals_are_said(open_kind: Findings, tmp_path: Path) -> None:
    (cause,) = open_kind.causes
    total = len(cause.rivals) + cause.rivals_omitted
    assert f", or one of {total - 3} more." in open_kind.sentence()
    html = open_kind.write(tmp_path).read_text(encoding="utf-8")
    assert f"and {cause.rivals_omitted} more within {RIVALS.log_odds} log-odds" in html
    few = cause.model_copy(update={"rivals": cause.rivals[:3], "rivals_omitted": 0})
    assert " more." not in open_kind.model_copy(update={"causes": [few]}).sentence()


def test_findings_without_the_count_are_read(open_kind: Findings, tmp_path: Path) -> None:
    content = json.loads(open_kind.to_json())
    path = tmp_path / "findings.json"
    for omitted, read in ((None, 0), (7, 7)):
        content["causes"][0].pop("rivals_omitted", None)
        content["causes"][0] |= {} if omitted is None else {"rivals_omitted": omitted}
        path.write_text(json.dumps(content), encoding="utf-8")
        assert load_findings(path).causes[0].rivals_omitted == read
    content["causes"][0]["rivals_omitted"] = -1
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(InputError, match="rivals_omitted"):
        load_findings(path)


def test_the_schema_has_the_count(rga: Callable[..., Any]) -> None:
    schema = json.loads(rga("schema", "findings").out)
    assert schema["$defs"]["Cause"]["properties"]["rivals_omitted"]["default"] == 0


def test_places_of_one_kind_leave_room_for_another(
    measured_bridge: dict[str, Any], welded: Model
) -> None:
    model = read_model(measured_bridge, "measured bridge")
    known = hypotheses(model, tuple(model.sensors), set(model.context))
    members = [one for one in known if one.name == "member_stiffness"]
    gains = [one for one in known if one.name == "sensor_gain"]
    (soft,) = [one for one in known if one.name == "elastic_modulus"]

    def ranked(*scored: tuple[Any, float]) -> list[Prospect]:
        return [
            Prospect(k, one, (1.0,), score, 9.0, 9.0, (1.0,))
            for k, (one, score) in enumerate(scored)
        ]

    alike = [(one, 1000.0 - k) for k, one in enumerate(members)]
    assert len(alike) > FITTED
    near, far = 1000 * HOPELESS + 1, 1000 * HOPELESS - 1
    prospects = ranked(*alike, (gains[0], 900.0), (gains[1], 899.0), (soft, near))
    assert worth_fitting(prospects) == [*prospects[:FITTED], prospects[-3], prospects[-1]]
    # What is hopelessly behind is not tried, and where all is alike nothing is added.
    assert worth_fitting(ranked(*alike, (soft, far))) == ranked(*alike)[:FITTED]
    assert worth_fitting([]) == []


@pytest.fixture(scope="module")
def soft_or_heavy(
    measured_bridge: dict[str, Any], measured_record: Recorded
) -> tuple[Model, Findings]:
    """A soft steel, or loads that are heavier than they read: a truck tells, wherever it stands."""
    names = ("D1", "D2", "D3", "DX")
    few = {"sensors": {name: measured_bridge["sensors"][name] for name in names}}
    model = read_model(measured_bridge | few, "four sensors")
    soft = {"kind": "elastic_modulus", "material": "steel", "factor": 0.85}
    findings = diagnose(model, measured_record(model, soft))
    (cause,) = findings.causes
    assert {cause.effect["kind"], cause.rivals[0]["kind"]} == {"elastic_modulus", "load_scale"}
    assert "a load test, known weights with the first at" in cause.separated_by
    return model, findings


def advising(findings: Findings, words: str) -> Findings:
    """The findings with another advice."""
    (cause,) = findings.causes
    changed = cause.model_copy(update={"separated_by": words})
    return findings.model_copy(update={"causes": [changed]})


def test_a_plan_begins_with_what_the_findings_advise(
    soft_or_heavy: tuple[Model, Findings],
) -> None:
    model, findings = soft_or_heavy
    advice = findings.causes[0].separated_by
    taken = set()
    for stand in ("1.50 m (node L1)", "3.75 m (node L2)", "6.00 m (node L3)"):
        begin = advice.index("the first at ") + len("the first at ")
        words = advice.replace(advice[begin : advice.index(")", begin) + 1], stand)
        planned = plan(model, advising(findings, words), sensors=1, positions=1)
        (one,), (test,) = planned.advised, planned.tests
        assert one.planned
        assert one.words == test.words
        assert one.d_perp == planned.separations[0].d_perp
        assert "The findings advise" not in planned.sentence
        taken.add(test.words)
    assert len(taken) == 3


def test_a_truck_at_either_end_of_its_path_separates_as_far(
    soft_or_heavy: tuple[Model, Findings],
) -> None:
    """Its place is known to 5 cm, and no axle leaves the path for that."""
    model, findings = soft_or_heavy
    separations = []
    for stand in ("1.50 m (node L1)", "6.00 m (node L3)"):
        words = f"a load test, known weights with the first at {stand}, "
        words += "100 and 100 kN, 1.5 m apart, "
        (one,) = plan(model, advising(findings, words), sensors=0, positions=1).advised
        separations.append(one.d_perp)
    assert separations[0] == pytest.approx(separations[1], rel=0.1)


def test_what_is_advised_and_worse_is_compared(soft_or_heavy: tuple[Model, Findings]) -> None:
    model, findings = soft_or_heavy
    useless = "the displacement of node L4 along x"
    advised = advising(findings, f"against it: measuring {useless} tells them apart (d_perp 9)")
    for sensors in (0, 1):
        planned = plan(model, advised, sensors=sensors, positions=1)
        (one,), (only,) = planned.advised, planned.separations
        assert (one.words, one.planned) == (useless, False)
        assert one.d_perp < only.d_perp / 2
        assert f"The findings advise {useless}: by itself that gives d_perp" in planned.sentence
        assert only.separated


def test_a_plan_without_advice_says_nothing_of_it(soft_or_heavy: tuple[Model, Findings]) -> None:
    model, findings = soft_or_heavy
    nowhere = "measuring the strain of member of another bridge tells them apart"
    plain, other = (plan(model, advising(findings, words), sensors=0) for words in ("", nowhere))
    assert plain.advised == other.advised == []
    assert plain.sentence == other.sentence
    assert "The findings advise" not in plain.sentence
    assert plain.tests == other.tests != []


def test_the_rival_of_the_advice_is_in_the_plan(open_kind: Findings) -> None:
    (cause,) = open_kind.causes
    assert len(cause.rivals) > NEAREST
    for rival in cause.rivals:
        against = f"against {effect_words(rival)}: measuring the strain of member L0-L1"
        changed = advising(open_kind, against)
        pairs = rival_pairs(open_kind.account.model, changed)
        assert pairs[0][1].words == effect_words(rival)
        assert len(pairs) == (NEAREST + 1) * NEAREST / 2
