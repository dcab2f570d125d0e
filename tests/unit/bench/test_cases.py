"""Blind cases: what they promise about seeds, sizes, names and files."""

from __future__ import annotations

import ast
import csv
import json
from pathlib import Path

import numpy as np
import pytest

import rga_bench.synthetic as package
from rga_bench.synthetic import BRIDGES, Case, draw_case
from rga_bench.synthetic.physics.frame import DOFS


def same(a: Case, b: Case) -> bool:
    return (
        a.model == b.model
        and a.truth == b.truth
        and list(a.channels) == list(b.channels)
        and all(np.array_equal(a.channels[c], b.channels[c], equal_nan=True) for c in a.channels)
    )


@pytest.mark.parametrize("kind", ["null", "member_stiffness", "bearing_friction", "unknown"])
def test_same_seed_same_bits(kind: str) -> None:
    assert same(draw_case(7, kind=kind), draw_case(7, kind=kind))
    assert not same(draw_case(7, kind=kind), draw_case(8, kind=kind))


@pytest.mark.parametrize("kind", ["support_settlement", "sensor_gain", "sensor_bias"])
def test_null_and_hidden_differ_by_the_effect_alone(kind: str) -> None:
    for seed in range(3):
        hidden = draw_case(seed, kind=kind)
        facts = {"bridge": hidden.truth["bridge"], "reality": hidden.truth["reality"]}
        null = draw_case(seed, kind="null", **facts)
        assert null.model == hidden.model
        place = hidden.truth["place"]
        start = hidden.truth["onset"] or hidden.time[0]
        before = hidden.time < start
        moved = []
        for name, channel in hidden.channels.items():
            change = channel - null.channels[name]
            assert np.all(change[before & ~np.isnan(change)] == 0.0)
            if np.nanmax(np.abs(change)) > 0.0:
                moved.append(name)
        if "sensor" in place:
            assert moved == [place["sensor"]]
        else:
            assert moved
            assert not set(moved) & set(hidden.model["context"])
        if kind == "sensor_bias":
            change = (hidden.channels[moved[0]] - null.channels[moved[0]])[~before]
            assert change[~np.isnan(change)] == pytest.approx(hidden.truth["value"])


def test_context_error_is_measured_minus_true() -> None:
    hidden = draw_case(4, bridge="pratt", kind="context_bias")
    null = draw_case(4, bridge="pratt", kind="null", reality=hidden.truth["reality"])
    name = hidden.truth["place"]["context"]
    off = hidden.channels[name] - null.channels[name]
    assert off == pytest.approx(hidden.truth["value"])
    sensor = next(iter(hidden.model["sensors"]))
    assert np.array_equal(hidden.channels[sensor], null.channels[sensor], equal_nan=True)


@pytest.mark.parametrize("bridge", list(BRIDGES))
def test_model_refers_to_what_it_has(bridge: str) -> None:
    model = draw_case(3, bridge=bridge, kind="null").model
    groups = {g for m in model["members"].values() for g in m["groups"]}
    for member in model["members"].values():
        assert set(member["nodes"]) <= set(model["nodes"])
        assert member["section"] in model["sections"]
        assert member["material"] in model["materials"]
    for support in model["supports"].values():
        assert support["node"] in model["nodes"]
        assert set(support["fixed"]) <= set(DOFS)
    for sensor in model["sensors"].values():
        assert sensor.get("node") in model["nodes"] or sensor.get("member") in model["members"]
    for effect in model["effects"].values():
        assert set(effect.get("groups", {})) <= groups
        loaded = effect["path"] if effect["kind"] == "axle_load" else effect.get("forces", {})
        assert set(loaded) <= set(model["nodes"])
        for parameter in effect.values():
            if isinstance(parameter, dict) and "context" in parameter:
                assert parameter["context"] in model["context"]
    warmed = next(e for e in model["effects"].values() if e["kind"] == "temperature")["groups"]
    for member in model["members"].values():
        assert len(set(member["groups"]) & set(warmed)) == 1
    assert 20 <= len(model["sensors"]) <= 40


@pytest.mark.parametrize("seed", range(12))
def test_place_names_parts_of_the_model(seed: int) -> None:
    case = draw_case(seed, rows=80)
    model = case.model
    tables = {
        "group": {g for m in model["members"].values() for g in m["groups"]},
        **{one: set(model[one + "s"]) for one in ("material", "member", "support", "sensor")},
        "sensors": set(model["sensors"]),
        "context": set(model["context"]),
        "effect": set(model["effects"]),
        "axis": {"vertical", "lateral"},
        "dof": set(DOFS),
    }
    for key, named in case.truth["place"].items():
        if key != "direction":
            assert set([named] if isinstance(named, str) else named) <= tables[key]


def test_written_files_read_back(tmp_path: Path) -> None:
    case = draw_case(11, kind="sensor_fault")
    case.write(tmp_path / "a" / "case")
    folder = tmp_path / "a" / "case"
    assert sorted(p.name for p in folder.iterdir()) == ["model.json", "record.csv", "truth.json"]
    assert json.loads((folder / "model.json").read_text()) == case.model
    assert json.loads((folder / "truth.json").read_text()) == case.truth
    with (folder / "record.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(case.time)
    for name, channel in case.channels.items():
        read = np.array([float(row[name]) if row[name] else np.nan for row in rows])
        assert np.allclose(read, channel, rtol=1e-7, atol=1e-12, equal_nan=True)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"bridge": "golden gate"}, "no bridge 'golden gate'"),
        ({"kind": "gremlin"}, "no hidden kind 'gremlin'"),
        ({"reality": "virtual"}, "not 'virtual'"),
        ({"kind": "joint_rigidity", "reality": "truss"}, "is a frame reality"),
        ({"kind": "load_position", "bridge": "footbridge"}, "has nothing that 'load_position'"),
    ],
)
def test_wrong_names_are_refused(wrong: dict[str, str], says: str) -> None:
    names = {"bridge": None, "kind": None, "reality": None, **wrong}
    with pytest.raises(ValueError, match=says):
        draw_case(1, bridge=names["bridge"], kind=names["kind"], reality=names["reality"])


def test_imports_nothing_of_what_it_judges() -> None:
    for path in Path(package.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert node.level <= 1, path
                names = [] if node.level else [str(node.module)]
            else:
                continue
            for name in names:
                assert name.split(".")[0] not in ("rga", "scipy", "polars", "pydantic"), path
