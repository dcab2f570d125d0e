"""Plans: what they choose separates rivals, as physics of its own confirms; nothing else does."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga import Findings, diagnose, load_findings, load_model, load_record, plan
from rga.errors import InputError
from rga.findings.phrases import effect_words
from rga.model import Model, read_model
from rga_bench.synthetic.gauges import observe
from rga_bench.synthetic.physics.world import World

Hidden = Callable[[World], None]
ROWS, INTERVAL = 120, 1800.0
BAR = "L1-L2"
SOFT, HEAVY = "elastic modulus of steel", "load scale of deck"
THIN, MISREAD = f"member stiffness of {BAR}", f"sensor gain of S {BAR}"


@pytest.fixture
def bridge(small_bridge: dict[str, Any]) -> dict[str, Any]:
    """The small bridge under one measured deck load, with gauges and without displacements."""
    content: dict[str, Any] = json.loads(json.dumps(small_bridge))
    del content["context"]["west load"], content["context"]["east load"]
    del content["effects"]["west"], content["effects"]["east"]
    content["context"]["deck load"] = {"unit": "kN", "range": [0, 60], "noise": 0.1}
    content["effects"]["deck"] = {
        "kind": "nodal_load",
        "forces": {f"L{i}": [0, 0, -1000] for i in range(1, 4)},
        "factor": {"context": "deck load"},
    }
    content["materials"]["steel"] |= {"nu": 0.3, "density": 7850}
    content["sections"]["bar"] |= {"Iy": 1e-6, "Iz": 1e-6, "J": 1e-6}
    for member in content["members"].values():
        member["kind"] = "truss"
    for name in ("D1", "D2", "D3", "DX"):
        del content["sensors"][name]
    bar = {"kind": "strain", "member": BAR, "unit": "microstrain", "noise": 1.0}
    content["sensors"][f"S {BAR}"] = bar
    return content


def effect(kind: str, value: float, **place: Any) -> dict[str, Any]:
    """An effect with an interval of 3 %."""
    interval = [value * 0.97, value * 1.03]
    return {"kind": kind, **place, "factor": {"value": value, "ci90": interval}}


def found(cause: dict[str, Any], *rivals: dict[str, Any], sha256: str = "") -> Findings:
    """Findings that name a cause and rivals of it."""
    gap = {
        "before": 9.0,
        "after": 1.0,
        "held_out": {"before": 9.0, "after": 1.0, "gain": 8.0, "gain_ci90": [7.0, 9.0]},
        "by_sensor": {},
    }
    cause = {
        "effect": cause,
        "status": "ambiguous" if rivals else "named",
        "log_odds": 50.0,
        "d_prime": 10.0,
        "d_perp": 1.0,
        "rivals": list(rivals),
    }
    return Findings.model_validate(
        {
            "verdict": "ambiguous" if rivals else "named",
            "gap": gap,
            "causes": [cause],
            "unexplained": {"share": 0.0, "looks_like": "nothing"},
            "seed": 0,
            "model_sha256": sha256,
            "record_sha256": "",
        }
    )


def written(
    folder: Path, content: dict[str, Any], hide: Hidden, stands: list[float] | None = None
) -> tuple[Model, Findings]:
    """Model and diagnosis of a record that physics of its own made.

    Args:
        folder: for the files.
        content: of the model file.
        hide: changes the world.
        stands: positions at which a truck stood in the last rows, where the model has one.
    """
    draw = np.random.default_rng(11)
    world = World.of(content)
    world.scale_stiffness(np.exp(0.02 * draw.standard_normal(len(content["members"]))))
    hide(world)
    time = INTERVAL * np.arange(ROWS)
    days = time / 86400
    true = {
        "temperature": 10 + 8 * np.sin(2 * np.pi * days),
        "deck load": 30 * draw.random(ROWS),
        "truck": np.zeros(ROWS),
        "truck position": np.zeros(ROWS),
    }
    for number, place in enumerate(stands or []):
        rows = slice(ROWS - 8 * (number + 1), ROWS - 8 * number)
        true["truck"][rows], true["truck position"][rows] = 1.0, place
        true["deck load"][rows] = 0.0
    true = {name: true[name] for name in content["context"]}
    count = len(content["sensors"])
    readings = observe(world, true, time) * (1 + 0.01 * draw.standard_normal(count))
    noise = np.array([sensor["noise"] for sensor in content["sensors"].values()])
    readings = readings + noise * draw.standard_normal(readings.shape)
    measured = dict(true)
    measured["temperature"] = true["temperature"] + 0.3 * draw.standard_normal(ROWS)
    measured["deck load"] = true["deck load"] + 0.1 * draw.standard_normal(ROWS)
    columns = {"time": time, **measured, **dict(zip(content["sensors"], readings.T, strict=True))}
    pl.DataFrame(columns).write_csv(folder / "record.csv")
    (folder / "model.json").write_text(json.dumps(content), encoding="utf-8")
    model = load_model(folder / "model.json")
    return model, diagnose(model, load_record(folder / "record.csv", model))


def named(findings: Findings) -> tuple[set[str], set[str]]:
    """Kinds and places of the causes, and of their rivals."""

    def words(content: dict[str, Any]) -> str:
        return effect_words({k: v for k, v in content.items() if k != "factor"})

    causes = {words(cause.effect) for cause in findings.causes}
    return causes, {words(rival) for cause in findings.causes for rival in cause.rivals}


def soft(world: World) -> None:
    world.scale_stiffness(np.full(len(world.alpha), 0.85))


def heavy(world: World) -> None:
    world.load_factor["deck"] = 1 / 0.85


def thin(world: World) -> None:
    factor = np.ones(len(world.alpha))
    factor[list(world.model["members"]).index(BAR)] = 0.75
    world.scale_stiffness(factor)


def misread(world: World) -> None:
    world.sensor_ops.append(("gain", (f"S {BAR}", 1 / 0.75)))


@pytest.fixture
def alike(
    bridge: dict[str, Any], tmp_path: Path, hide: Hidden, both: set[str]
) -> tuple[Model, Findings]:
    """Model and diagnosis of a record in which two causes are named that are alike."""
    model, findings = written(tmp_path, bridge, hide)
    causes, rivals = named(findings)
    assert both <= causes | rivals
    return model, findings


@pytest.mark.parametrize(
    ("hide", "true", "both"),
    [(soft, SOFT, {SOFT, HEAVY}), (heavy, HEAVY, {SOFT, HEAVY})],
)
def test_a_truck_separates_soft_steel_from_heavy_loads(
    bridge: dict[str, Any],
    tmp_path: Path,
    hide: Hidden,
    true: str,
    both: set[str],
    alike: tuple[Model, Findings],
) -> None:
    """Exactly alike under the deck load; a truck of known weight is planned, and tells."""
    model, findings = alike
    assert "known weights" in findings.causes[0].separated_by

    planned = plan(model, findings, sensors=0, positions=2, seed=1)
    assert planned.sensors == []
    assert planned.tests
    assert all(test.position is not None for test in planned.tests)
    of_steel = [one for one in planned.separations if SOFT in one.one + one.other]
    assert of_steel
    assert all(one.separated and one.simulated.clearly >= 0.9 for one in of_steel)

    truck = planned.truck
    assert truck is not None
    bridge["context"]["truck"] = {"unit": "-", "range": [0, 1], "noise": 1e-6}
    bridge["context"]["truck position"] = {"unit": "m", "range": [0, 12], "noise": 0.02}
    bridge["effects"]["truck"] = {
        "kind": "axle_load",
        "path": truck.paths[0],
        "forces": [1e3 * load for load in truck.loads],
        "offsets": np.append(0.0, np.cumsum(truck.spacings)).tolist(),
        "factor": {"context": "truck"},
        "position": {"context": "truck position"},
    }
    stands = [test.position for test in planned.tests if test.position is not None]
    _, after = written(tmp_path, bridge, hide, stands)
    causes, rivals = named(after)
    assert causes & both == {true}
    assert not rivals & both


@pytest.mark.parametrize(
    ("hide", "true", "both"),
    [(thin, THIN, {THIN, MISREAD}), (misread, MISREAD, {THIN, MISREAD})],
)
def test_a_sensor_separates_a_thin_bar_from_a_gauge_that_misreads(
    bridge: dict[str, Any],
    tmp_path: Path,
    hide: Hidden,
    true: str,
    both: set[str],
    alike: tuple[Model, Findings],
) -> None:
    """Alike on one gauge a bar of a determinate truss; the sensor that is planned tells."""
    model, findings = alike
    planned = plan(model, findings, sensors=1, positions=0, seed=1)
    assert len(planned.sensors) == 1
    assert all(one.separated for one in planned.separations)

    sensor = planned.sensors[0].sensor
    assert sensor is not None
    bridge["sensors"]["added"] = sensor
    _, after = written(tmp_path, bridge, hide)
    causes, rivals = named(after)
    assert causes & both == {true}
    assert not rivals & both


def test_nothing_separates_what_is_exactly_alike(bridge: dict[str, Any]) -> None:
    """The null twin: softer steel, and all bars (of that steel) thinner by as much."""
    model = read_model(bridge, "bridge")
    soft_steel = effect("elastic_modulus", 0.85, material="steel")
    thin_bars = effect("member_stiffness", 0.85, group=sorted(model.groups))
    planned = plan(model, found(soft_steel, thin_bars), sensors=5, positions=5)
    assert planned.sensors == []
    assert planned.tests == []
    (only,) = planned.separations
    assert only.d_perp_at_best < 0.1
    assert not only.separated
    assert "Nothing affordable" in planned.sentence


def test_a_second_thermometer_separates_expansion_from_a_thermometer_that_misreads(
    bridge: dict[str, Any],
) -> None:
    bridge["sensors"]["DX"] = {
        "kind": "displacement",
        "node": "L4",
        "direction": [1, 0, 0],
        "unit": "mm",
        "noise": 0.05,
    }
    model = read_model(bridge, "bridge")
    expansion = effect("thermal_expansion", 1.2, material="steel")
    thermometer = effect("context_gain", 1 / 1.2, context="temperature")
    planned = plan(model, found(expansion, thermometer), sensors=1, positions=0)
    assert [sensor.context for sensor in planned.sensors] == ["temperature"]
    assert planned.separations[0].separated

    misread = effect("sensor_gain", 1.2, sensor="DX")
    planned = plan(model, found(expansion, thermometer, misread), sensors=2, positions=0)
    assert {sensor.context for sensor in planned.sensors} == {"temperature", None}
    assert len(planned.separations) == 3
    assert all(one.separated for one in planned.separations)


def test_no_budget_buys_nothing(bridge: dict[str, Any]) -> None:
    model = read_model(bridge, "bridge")
    cause = effect("elastic_modulus", 0.85, material="steel")
    rival = effect("load_scale", 1 / 0.85, effect="deck")
    planned = plan(model, found(cause, rival), sensors=0, positions=0)
    assert (planned.sensors, planned.tests, planned.cost) == ([], [], 0)
    assert planned.separations[0].d_perp == 0
    assert planned.separations[0].d_perp_at_best > 5
    assert "This budget does not tell" in planned.sentence


def test_a_named_cause_is_confirmed_against_no_effect(bridge: dict[str, Any]) -> None:
    cause = effect("elastic_modulus", 0.8, material="steel")
    planned = plan(read_model(bridge, "bridge"), found(cause))
    assert [one.other for one in planned.separations] == ["the model as it is"]
    assert planned.separations[0].separated


def test_findings_without_a_cause_leave_nothing_to_plan(bridge: dict[str, Any]) -> None:
    findings = found(effect("elastic_modulus", 0.8, material="steel"))
    findings = findings.model_copy(update={"causes": [], "verdict": "nothing_wrong"})
    planned = plan(read_model(bridge, "bridge"), findings)
    assert planned.separations == []
    assert "nothing to tell apart" in planned.sentence


@pytest.fixture
def files(bridge: dict[str, Any], tmp_path: Path) -> Path:
    """model.json and findings.json of an ambiguous diagnosis."""
    (tmp_path / "model.json").write_text(json.dumps(bridge), encoding="utf-8")
    findings = found(
        effect("elastic_modulus", 0.85, material="steel"),
        effect("load_scale", 1 / 0.85, effect="deck"),
        sha256=load_model(tmp_path / "model.json").sha256,
    )
    (tmp_path / "findings.json").write_text(findings.to_json(), encoding="utf-8")
    return tmp_path


def test_the_command_writes_what_it_says(files: Path, rga: Callable[..., Any]) -> None:
    done = rga("plan", files / "model.json", files, "-o", files / "plan.json", "--seed", "4")
    assert done.code == 0
    assert "Known weights of" in done.out
    assert "known weights with the first at" in done.out
    content = json.loads((files / "plan.json").read_text(encoding="utf-8"))
    assert content["seed"] == 4
    assert "best of its kind" in done.out
    assert {one["kind"] for one in content["ranked"]} >= {"strain", "load test"}
    assert all(test["words"] in content["sentence"] for test in content["tests"])
    assert content["sentence"] in done.out
    again = rga("plan", files / "model.json", files / "findings.json", "--seed", "4", "--json")
    assert json.loads(again.out) == content


def test_findings_are_read_back(files: Path) -> None:
    findings = load_findings(files)
    assert findings.to_json() == (files / "findings.json").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--truck", "60,-100@3.5"], "not above zero"),
        (["--truck", "60,100@0"], "not above zero"),
        (["--truck", "60,1e300@3.5"], "stands on no structure"),
        (["--truck", "nan"], "not above zero"),
        (["--truck", "60,100"], "2 axles have 0 spacings"),
        (["--truck", "lorry"], "is no truck"),
        (["--truck", ""], "is no truck"),
        (["--truck", "60,100@50"], "50 m long"),
        (["--path", "L0,nowhere"], "no node 'nowhere'"),
        (["--path", "L0"], "is no path"),
        (["--path", "L0,L1,L0"], "is no path"),
        (["--sensors", "-1"], "sensors are -1"),
        (["--positions", "-1"], "positions are -1"),
    ],
)
def test_bad_options_get_one_clear_line(
    files: Path, rga: Callable[..., Any], options: list[str], said: str
) -> None:
    refused = rga("plan", files / "model.json", files, *options)
    assert refused.code == 2
    assert said in refused.err
    assert len(refused.err.strip().splitlines()) == 1


def test_findings_of_another_model_are_refused(files: Path, rga: Callable[..., Any]) -> None:
    text = (files / "model.json").read_text(encoding="utf-8")
    (files / "other.json").write_text(text + "\n", encoding="utf-8")
    refused = rga("plan", files / "other.json", files)
    assert refused.code == 2
    assert "another model" in refused.err


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text[:40], "no JSON"),
        (lambda text: "[]", "no findings"),
        (lambda text: "[" * 100_000, "no JSON"),
        (lambda text: text.replace('"verdict": "ambiguous"', '"verdict": "sure"'), "verdict"),
        (lambda text: text.replace('"material": "steel"', '"material": "wood"'), "wood"),
        (lambda text: text.replace('"elastic_modulus"', '"wishful_thinking"'), "wishful"),
        (lambda text: text.replace('"value": 0.85', '"value": -0.85'), "cannot be"),
        (lambda text: text.replace('"value": 0.85', '"value": "low"'), "factor"),
    ],
)
def test_bad_findings_get_one_clear_line(
    files: Path, rga: Callable[..., Any], change: Callable[[str], str], said: str
) -> None:
    path = files / "findings.json"
    text = path.read_text(encoding="utf-8")
    path.write_text(change(text), encoding="utf-8")
    assert path.read_text(encoding="utf-8") != text
    refused = rga("plan", files / "model.json", path)
    assert refused.code == 2
    assert said in refused.err
    assert len(refused.err.strip().splitlines()) == 1


def test_findings_that_are_missing_are_reported(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load_findings(tmp_path)
