"""The second generator: its solver against the simulator's, its seeds, its spreads, its files."""

from __future__ import annotations

import ast
from dataclasses import replace
from math import gcd
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga_bench.field as field
from rga.errors import InputError
from rga.model import load_model, read_model
from rga.records import load_record
from rga.simulation import Simulator
from rga_bench.diagnosis.blind_draw import draws
from rga_bench.diagnosis.design import Draw
from rga_bench.diagnosis.field_design import (
    FIELD_CIRCUMSTANCES,
    FIELD_NULLS,
    FieldDraw,
    draw_of,
)
from rga_bench.diagnosis.judge import judge
from rga_bench.diagnosis.permitted_causes import PermittedCauses
from rga_bench.diagnosis.tables import tables
from rga_bench.field import INSIDE, KINDS, OUTSIDE, STRUCTURES, Options, draw_field, fits
from rga_bench.field.as_built import as_built
from rga_bench.field.solver import Bars, Solved, axes_of
from rga_bench.field.world import FieldWorld, amplitudes, influence
from rga_bench.synthetic import Case

E, A, INERTIA = 2.1e11, 0.01, 4.0e-5


def contexts(model: dict[str, Any], rows: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(3)
    return {name: rng.uniform(*one["range"], rows) for name, one in model["context"].items()}


@pytest.mark.parametrize("name", STRUCTURES)
def test_pinned_and_at_the_centroid_it_is_what_the_simulator_says(name: str) -> None:
    for seed in range(3):
        structure = STRUCTURES[name](np.random.default_rng(seed))
        model = read_model(structure.model, name)
        known = contexts(structure.model, 6)
        expected = Simulator(model).predict({**known, "time": np.arange(6.0)})
        world = FieldWorld.of(structure)
        found = amplitudes(world, known) @ influence(world)
        scale = np.abs(expected).max(axis=0) + 1e-6 * np.abs(expected).max()
        assert np.abs((found - expected) / scale).max() < 1e-6
        assert 16 <= len(model.sensors) <= 32
        assert 2 <= len(model.context) <= 4


@pytest.mark.parametrize("kind", INSIDE)
def test_hidden_effects_are_what_the_simulator_says(kind: str, tmp_path: Path) -> None:
    """On a structure that is as drawn, the change is that of the same effect in a model."""
    from rga_bench.diagnosis.hidden import Truth
    from rga_bench.field.hidden import FieldSetting

    name = "K truss" if kind == "support_spring" else "portal"
    structure = STRUCTURES[name](np.random.default_rng(2))
    world = FieldWorld.of(structure)
    known = contexts(structure.model, 8)
    time = 3600.0 * np.arange(8)
    sound = amplitudes(world, known) @ influence(world)
    span = KINDS[kind].draw(FieldSetting(world, time, sound), np.random.default_rng(4))
    assert span is not None
    value = span.at(0.7)
    other = world.copy()
    span.act(other, value, None)
    changed = amplitudes(other, known) @ influence(other)
    for op, what in other.ops:
        if op == "swap":
            changed[:, list(what)] = changed[:, list(what)[::-1]]
        elif op == "gain":
            changed[:, what[0]] *= what[1]
        elif op == "bias":
            changed[:, what[0]] += what[1]
        else:
            changed[:, what[0]] += what[1] * time / 86400.0
    values = {span.parameter: value} if span.parameter else {}
    effect = Truth(kind, span.place, values, None, None, 0.0).effect()
    model = read_model(structure.model, name).extended({"hidden": effect})
    expected = Simulator(model).predict({**known, "time": time})
    assert np.abs(changed - sound).max() > 1e-3 * np.abs(sound).max()
    assert np.abs(changed - expected).max() < 1e-6 * np.abs(expected).max()


def test_a_cantilever_with_a_rigid_root_bends_as_the_book_says() -> None:
    length, root = 3.0, 0.4
    xyz = np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]])
    one = np.ones(1)
    bars = Bars(
        np.array([[0, 1]]), axes_of(xyz[1], None)[None], E * A * one, E * INERTIA * one,
        2.0 * E * INERTIA * one, 1e6 * one, 1.2e-5 * one, np.array([False]), 0.0 * one,
    )  # fmt: skip
    for zone in (0.0, root):
        force = np.zeros((12, 1))
        force[8] = -1e4
        # With a rigid length at either end the tip turns along with the clear part's end.
        solved = Solved(
            xyz, replace(bars, zone=zone * one), set(range(6)), {}, force, np.zeros((1, 1)),
            np.zeros((12, 1)),
        )  # fmt: skip
        clear, stiff = length - 2.0 * zone, E * INERTIA
        moment = 1e4 * zone
        drop = 1e4 * clear**3 / (3 * stiff) + moment * clear**2 / (2 * stiff)
        turn = 1e4 * clear**2 / (2 * stiff) + moment * clear / stiff
        assert solved.u[8, 0] == pytest.approx(-(drop + turn * zone))
        at_root = solved.strain(0, 0.0, 0.0, 0.1)[0]
        assert at_root == pytest.approx(1e4 * (clear + zone) / stiff * 0.1)


def same(one: Case, other: Case) -> bool:
    if (one.model, one.truth, one.mapping) != (other.model, other.truth, other.mapping):
        return False
    return list(one.channels) == list(other.channels) and all(
        np.array_equal(a, b, equal_nan=True)
        for a, b in zip(one.channels.values(), other.channels.values(), strict=True)
    )


ALL = Options(tared=True, gaps=True, quantised=True, broken=True)


@pytest.mark.parametrize("name", STRUCTURES)
def test_a_seed_draws_the_same_bits_and_every_file_is_read(name: str, tmp_path: Path) -> None:
    given: dict[str, Any] = {"structure": name, "welded": True, "rows": 60, "options": ALL}
    case = draw_field(11, kind="sensor_gain", **given)
    assert same(case, draw_field(11, kind="sensor_gain", **given))
    assert not same(case, draw_field(12, kind="sensor_gain", **given))
    case.write(tmp_path)
    model = load_model(tmp_path / "model.json")
    record = load_record(tmp_path / "record.csv", model)
    assert record.zero is not None
    assert len(record) == 60
    assert (tmp_path / "import.toml").is_file()
    gaps = np.diff(record.time)
    assert (gaps > 5 * np.median(gaps)).sum() == 2
    assert case.truth["broken"]["sensor"] in record.sensors


def test_cases_differ_by_what_is_hidden_alone() -> None:
    null = draw_field(4, structure="K truss", rows=80)
    case = draw_field(4, structure="K truss", kind="member_stiffness", rows=80)
    assert null.beyond is not None
    assert case.beyond is not None
    assert null.truth["kind"] == "null"
    assert case.truth["d_prime"] > 5.0
    for column, name in enumerate(case.model["sensors"]):
        change = (case.beyond.clean - null.beyond.clean)[:80, column]
        left = case.channels[name] - null.channels[name] - change
        assert np.nanmax(np.abs(left)) < 1e-9
    late = case.truth["onset"]
    before = case.beyond.time < (np.inf if late is None else late)
    if late is not None:
        assert np.abs(case.beyond.together[before]).max() == 0.0
    assert np.abs(case.beyond.together).max() > 0.0
    assert np.abs(null.beyond.together).max() == 0.0


def test_a_tare_takes_the_effect_off_its_rows() -> None:
    case = draw_field(
        6, structure="portal", kind="sensor_bias", rows=80, options=Options(tared=True)
    )
    assert case.truth["onset"] is not None
    assert case.beyond is not None
    column = list(case.model["sensors"]).index(case.truth["place"]["sensor"])
    late = case.beyond.time >= case.truth["onset"]
    assert np.allclose(case.beyond.together[late, column], case.truth["value"])
    assert np.allclose(case.beyond.together[~late, column], 0.0)


@pytest.mark.parametrize("kind", OUTSIDE)
def test_what_no_vocabulary_has_is_drawn(kind: str) -> None:
    name = next(one for one in ("roof", "portal") if fits(kind, one))
    case = draw_field(3, structure=name, kind=kind, rows=60, aims=(20.0, 30.0))
    assert case.beyond is not None
    assert case.truth["d_prime"] > 10.0
    assert np.abs(case.beyond.together).max() > 0.0
    assert case.truth["parameter"] is None


def test_spreads_are_those_of_the_codes() -> None:
    structure = STRUCTURES["roof"](np.random.default_rng(1))
    world = FieldWorld.of(structure)
    rng = np.random.default_rng(2)
    drawn = [as_built(structure, rng, True, 1.0) for _ in range(60)]
    factors = np.log([one.bars.ea / world.bars.ea for one in drawn])
    # E of 0.03 and areas of 0.035, drawn apart.
    assert factors.std() == pytest.approx(np.hypot(0.03, 0.035), rel=0.12)
    assert np.abs(factors).max() <= 0.12 + 1e-9
    chords = np.array([m["section"] == "chord" for m in structure.model["members"].values()])
    alike = np.mean([np.var(one[chords]) for one in factors])
    assert alike < 0.85 * factors[:, chords].var()
    half = [as_built(structure, rng, True, 0.5) for _ in range(20)]
    smaller = np.log([one.bars.ea / world.bars.ea for one in half]).std()
    assert smaller == pytest.approx(0.5 * factors.std(), rel=0.2)
    assert not drawn[0].bars.pinned.any()
    assert drawn[0].bars.zone.min() > 0.0
    off = np.array([np.hypot(g.y, g.z) for one in drawn for g in one.gauges.values()])
    assert 0.003 < off.min() < off.max() <= 0.0501
    pinned = as_built(structure, rng, False, 1.0)
    assert pinned.bars.pinned.all()
    assert all(tuple(one) == (0.5, 0.0, 0.0) for one in pinned.gauges.values())


def test_unknown_words_are_refused() -> None:
    with pytest.raises(ValueError, match="no hidden kind"):
        draw_field(1, kind="gremlins")
    with pytest.raises(ValueError, match="no structure"):
        draw_field(1, structure="castle")
    with pytest.raises(ValueError, match="nothing that"):
        draw_field(1, structure="portal", kind="jamming")


def test_its_physics_shares_nothing_with_the_simulator() -> None:
    folder = Path(field.__file__).parent
    for path in folder.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [a.name for a in node.names] if isinstance(node, ast.Import) else []
            for name in names:
                assert not name.startswith(
                    (
                        "rga.simulation",
                        "rga.diagnosis",
                        "rga._core",
                        "rga_bench.synthetic.physics.frame",
                    )
                ), f"{path.name} imports {name}"


@pytest.mark.thorough
def test_draws_of_the_challenge_are_balanced_and_named() -> None:
    order = draws(3, 105, FieldDraw)
    hidden = order[::2]
    assert [replace(one, null=True) for one in hidden] == order[1::2]
    assert {one.recorded.null for one in order} == set(FIELD_NULLS)
    assert {one.bridge for one in hidden} == set(STRUCTURES)
    # Kinds and circumstances go round in turn: without a common divisor, each meets each.
    assert gcd(len(FIELD_CIRCUMSTANCES), len(INSIDE) * len(OUTSIDE)) == 1
    for one in order[:20]:
        assert draw_of(one.id) == one
        assert type(draw_of(one.id)) is FieldDraw
        assert all(fits(kind, one.bridge) for kind in one.kinds)
    assert type(draw_of("3-single-1")) is Draw
    with pytest.raises(InputError, match="names no case"):
        draw_of("field-3-double-1")


def test_a_null_twin_differs_by_what_is_hidden_alone() -> None:
    draw = draw_of("field-1-single-4")
    case, null = draw.case(), replace(draw, null=True).case()
    assert same(case, draw.case())
    assert case.truth["broken"] == null.truth["broken"]
    assert case.truth["broken"] is not None
    assert case.model == null.model
    assert case.truth["kind"] == draw.kinds[0]
    assert null.truth["kind"] == "null"


def test_a_diagnosis_of_the_field_is_judged() -> None:
    found = judge(draw_of("field-1-outside-0-null"))
    assert found.bridge == "K truss"
    assert found.hidden == []
    assert found.named == []
    assert found.broken_told is None
    page = tables([found, replace(found, id="field-1-single-3-null", broken_told=False)])
    assert "a name on a null record: pinned" in page
    assert "on all null records, pinned" in page
    assert "a broken channel is a cause or a rival" in page
    assert "K truss" in page


def test_what_is_true_though_not_hidden_is_no_mistake() -> None:
    member = {"material": "steel", "groups": ["chord"], "nodes": ["u", "v"]}
    model = {"nodes": {"u": [0, 0, 0], "v": [0, 3, 4]}, "members": {"a": member, "b": member}}
    pinned = {"a": 0.0, "b": 0.0}
    known = PermittedCauses(("joint_rigidity",), "S1", {"a": 0.9, "b": 0.9}, pinned, model)
    modulus = {"kind": "elastic_modulus", "material": "steel", "factor": {"value": 0.91}}
    assert known.has(modulus)
    assert not known.has({**modulus, "factor": 1.08})
    assert not known.has({**modulus, "factor": 0.7})
    assert not known.has({**modulus, "onset": 3.0})
    nearly = PermittedCauses(stiffness={"a": 1.01, "b": 1.0}, gussets=pinned, model=model)
    assert not nearly.has({**modulus, "factor": 1.01})
    one = {"kind": "member_stiffness", "member": "a", "factor": 0.9}
    assert known.has(one)
    assert not known.has({**one, "factor": 0.5})
    assert not known.has({**one, "factor": 1.1})
    # Gussets of 0.5 m at both ends of 5 m leave 4 m that give way.
    assert replace(known, gussets={"a": 0.5, "b": 0.5}).has({**one, "factor": 1.1})
    assert known.has({"kind": "member_stiffness", "group": "chord", "factor": 0.88})
    assert known.has({"kind": "joint_rigidity", "group": "chord"})
    assert known.has({"kind": "sensor_swap", "sensors": ["S2", "S1"]})
    assert not known.has({"kind": "sensor_bias", "sensor": "S2"})
    assert not PermittedCauses().has({"kind": "sensor_bias", "sensor": "S1"})
    beside = PermittedCauses(
        gauges={"S1": [0.5, -0.012, 0.251]}, model={"sensors": {"S1": {"z": 0.25}}}
    )
    position = {"kind": "gauge_position", "sensor": "S1", "y": {"value": -0.01}, "z": 0.008}
    assert beside.has(position)
    assert not beside.has({**position, "y": 0.01})
    assert not beside.has({**position, "sensor": "S2"})
    assert not PermittedCauses().has(position)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("field-2031-outside-8", marks=pytest.mark.thorough),
        "field-2033-single-31-null",
    ],
)
def test_a_channel_of_its_own_response_names_nothing(name: str) -> None:
    """Cross-talk, or a gauge at a welded gusset: else a steel is softer, or a gauge broken."""
    outcome = judge(draw_of(name))
    assert outcome.verdict in ("partial", "unknown")
    assert outcome.named == []
