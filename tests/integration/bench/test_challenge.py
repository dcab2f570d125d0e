"""The blind challenge itself: its draws, its judge, its ledger and its figures."""

from dataclasses import replace
from math import gcd
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model, read_model
from rga.records import Record, load_record
from rga_bench.diagnosis.blind_draw import draws
from rga_bench.diagnosis.design import CIRCUMSTANCES, NULLS, SINGLES, STRATA, Draw
from rga_bench.diagnosis.experiment import DiagnosisExperiment
from rga_bench.diagnosis.figures import ChallengeFigure, figures, rate
from rga_bench.diagnosis.hidden import Truth
from rga_bench.diagnosis.judge import DrawOutcome, judge
from rga_bench.diagnosis.plots import plot
from rga_bench.diagnosis.reference_fit import ReferenceFit
from rga_bench.diagnosis.tables import failures, tables
from rga_bench.experiment import Execution
from rga_bench.ledger import NAME, Ledger, task_versions
from rga_bench.synthetic import Case, Conditions, draw_case


def outcome(name: str, **changes: Any) -> DrawOutcome:
    """An outcome of an effect that was found, or of its null twin."""
    draw = Draw.parse(name)
    hidden = [
        {
            "kind": kind,
            "place": {},
            "values": {},
            "onset": None,
            "end": None,
            "d_prime": 25.0,
            "d_perp": 12.0,
            "nearest": None,
            "found": True,
            "cause": 0,
        }
        for kind in (() if draw.null else draw.kinds)
    ]
    usual = DrawOutcome(
        id=name,
        null=draw.circumstance.null,
        contexts=draw.circumstance.conditions.contexts,
        bridge=draw.bridge,
        reality="truss",
        hidden=hidden,
        verdict="nothing_wrong" if draw.null else "named",
        named=[
            {"kind": one["kind"], "hidden": True, "log_odds": 20.0, "rivals": []} for one in hidden
        ],
        deviations={one["kind"]: {"factor": 0.5} for one in hidden},
        onsets=[],
        gaps=None if draw.null else {"given": 5.0, "found": 1.2, "true": 1.0},
        gain_covered=None if draw.null else True,
        chances=[(0.9, True), (0.1, False)],
        seconds=1.0,
        model_sha256="",
    )
    return replace(usual, **changes)


def figure(outcomes: list[DrawOutcome], beginning: str) -> ChallengeFigure:
    (found,) = [one for one in figures(outcomes) if one.name.startswith(beginning)]
    return found


def test_every_beginning_of_the_draws_is_balanced() -> None:
    order = draws(3, 200, Draw)
    assert len(order) == 400
    for count in (20, 60, 200):
        begun = order[: 2 * count]
        assert [one.null for one in begun] == [False, True] * count
        assert [replace(one, null=True) for one in begun[::2]] == begun[1::2]
        for stratum, share in STRATA.items():
            assert abs(sum(one.stratum == stratum for one in begun) / 2 - share * count) <= 1.0
    # Kinds and circumstances go round in turn: without a common divisor, each meets each.
    assert gcd(len(SINGLES), len(CIRCUMSTANCES)) == 1
    assert {one.circumstance.null for one in order} == set(NULLS)
    assert set(draws(3, 100, Draw)) < set(order)


def test_a_name_draws_its_case_again() -> None:
    for one in draws(5, 20, Draw):
        assert Draw.parse(one.id) == one
    for wrong in ("5-single", "x-single-3", "5-double-3", "5-single-3-nil", ""):
        with pytest.raises(InputError, match="names no case"):
            Draw.parse(wrong)


def same(one: Case, other: Case) -> bool:
    if (one.model, one.truth, list(one.channels)) != (
        other.model,
        other.truth,
        list(other.channels),
    ):
        return False
    pairs = zip(one.channels.values(), other.channels.values(), strict=True)
    return all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)


@pytest.mark.parametrize("name", ["2-single-4", "2-single-17", "2-pair-2", "2-outside-1"])
def test_a_draw_depends_on_its_name_alone(name: str) -> None:
    draw = Draw.parse(name)
    case, null = draw.case(), replace(draw, null=True).case()
    assert same(case, draw.case())
    assert not same(case, Draw.parse("9" + name[1:]).case())
    assert case.truth["kind"] == draw.kinds[0]
    assert [one["kind"] for one in case.truth["beside"]] == list(draw.kinds[1:])
    assert null.truth["kind"] == "null"
    assert null.model == case.model
    assert null.beyond is not None
    assert case.beyond is not None
    assert np.array_equal(null.time, case.time)
    for name, channel in case.channels.items():
        if name in case.model["sensors"]:
            # Noise is the same in both: what differs is the effect.
            column = list(case.beyond.sensors).index(name)
            effect = (case.beyond.clean - null.beyond.clean)[: len(case.time), column]
            if "sensor_fault" not in draw.kinds:
                left = channel - null.channels[name] - effect
                assert np.nanmax(np.abs(left)) < 1e-9 * (1 + np.nanmax(np.abs(channel)))


def test_rows_and_sensors_are_kept_from_the_record() -> None:
    case = Draw.parse("1-single-36").case()
    beyond = case.beyond
    assert beyond is not None
    rows = len(case.time)
    hidden = set(beyond.sensors) - set(case.model["sensors"])
    assert len(hidden) == round(0.2 * len(beyond.sensors))
    assert len(beyond.time) == rows + 60
    assert beyond.unseen[rows:].all()
    for number, name in enumerate(beyond.sensors):
        assert beyond.unseen[:rows, number].all() == (name in hidden)
    warm = beyond.contexts["air"]
    assert warm[rows:].mean() > warm[:rows].mean() + 5


def test_conditions_are_as_they_are_called() -> None:
    def drawn(**conditions: Any) -> Case:
        changes: Any = conditions
        return draw_case(
            3, bridge="pratt", kind="null", reality="truss", rows=600,
            conditions=Conditions(later=1, **changes),
        )  # fmt: skip

    def noise(case: Case) -> np.ndarray:
        assert case.beyond is not None
        sensors = case.model["sensors"]
        return np.array(
            [
                (case.channels[name] - case.beyond.clean[:600, k]) / sensors[name]["noise"]
                for k, name in enumerate(sensors)
            ]
        )

    def memory(of: np.ndarray) -> float:
        return float(np.nanmean(of[:, 1:] * of[:, :-1]) / np.nanmean(of**2))

    white, long = noise(drawn(noise="white")), noise(drawn(noise="long memory"))
    heavy = noise(drawn(noise="heavy tails"))
    assert abs(memory(white)) < 0.03
    assert memory(long) == pytest.approx(0.6, abs=0.05)
    assert (np.abs(white) > 5).mean() < 1e-4 < (np.abs(heavy) > 5).mean()
    known, latent, uneven = (
        drawn(contexts="known"),
        drawn(contexts="latent"),
        drawn(sampling="uneven"),
    )
    assert known.beyond is not None
    assert np.array_equal(known.channels["crowd"], known.beyond.contexts["crowd"][:600])
    assert len(set(latent.model["context"]) - set(latent.channels)) == 1
    assert np.ptp(np.diff(uneven.time)) > 0
    gaps = np.diff(drawn(sampling="gaps").time)
    assert (gaps > 20 * np.median(gaps)).sum() == 2


def test_a_ramp_grows() -> None:
    conditions = Conditions(ramps=True, later=1)
    for seed in range(40):
        case = draw_case(seed, bridge="pratt", kind="sensor_bias", conditions=conditions)
        if case.truth["end"] is not None:
            break
    truth, beyond = case.truth, case.beyond
    assert beyond is not None
    column = list(beyond.sensors).index(truth["place"]["sensor"])
    weight = (beyond.time - truth["onset"]) / (truth["end"] - truth["onset"])
    expected = truth["value"] * np.clip(weight, 0.0, 1.0)
    np.testing.assert_allclose(beyond.together[:, column], expected, atol=1e-9)


def loaded(case: Case, folder: Path) -> tuple[Model, Record]:
    case.write(folder)
    model = read_model(case.model, "case")
    return model, load_record(folder / "record.csv", model)


def test_the_reference_fit_knows_size_and_place_of_the_truth(tmp_path: Path) -> None:
    case = draw_case(
        4,
        bridge="footbridge",
        kind="load_scale",
        reality="truss",
        conditions=Conditions(scatter=0.01, later=20, unseen=0.2),
        aims=(20.0, 30.0),
    )
    reference = ReferenceFit(case, *loaded(case, tmp_path))
    (size,) = reference.sizes()
    # Both accounts of noise and scatter are rough; they are of one size.
    assert case.truth["d_prime"] / 3 < size.d_prime < 3 * case.truth["d_prime"]
    assert size.d_perp <= size.d_prime
    off = reference.deviations(beside_joints=False)["load_scale"]["factor"]
    assert abs(off) < 4
    (truth,) = Truth.of(case)
    value = truth.values["factor"]
    stated = {"value": value, "ci90": (value / 1.1, value * 1.1)}
    assert reference.deviations_reported(truth, {"factor": stated})["factor"] == pytest.approx(
        0, abs=1e-9
    )


def test_kind_and_place_must_be_right() -> None:
    truth = Truth("support_spring", {"support": ["a", "b"], "dof": "ux"}, {}, None, None, 0.0)
    assert truth.is_at({"kind": "support_spring", "support": ["b", "a"], "dof": "ux"})
    assert not truth.is_at({"kind": "support_spring", "support": "a", "dof": "ux"})
    assert not truth.is_at({"kind": "support_spring", "support": ["b", "a"], "dof": "uy"})
    assert not truth.is_at({"kind": "support_gap", "support": ["b", "a"], "dof": "ux"})
    joints = Truth("joint_rigidity", {"group": ["a", "b"]}, {}, None, None, 0.0)
    assert joints.is_at({"kind": "joint_rigidity", "group": ["c", "b", "a"]})
    assert not joints.is_at({"kind": "joint_rigidity", "group": "a"})
    wind = Truth("unmodelled_load", {"group": "g", "direction": [0, 0, -1]}, {}, None, None, 0.0)
    assert wind.is_at({"kind": "unmodelled_load", "group": "g", "direction": (0.0, 0.0, 1.0)})
    assert not wind.is_at({"kind": "unmodelled_load", "group": "g", "direction": (0.0, 1.0, 0.0)})


def test_figures_count_what_they_say() -> None:
    plain = [outcome(f"1-single-{k}") for k in range(40)]
    missed = {**plain[0].hidden[0], "found": False, "cause": None}
    plain[0] = replace(plain[0], hidden=[missed], named=[], verdict="unknown")
    faint = replace(plain[1], id="1-single-41", hidden=[{**missed, "d_perp": 6.0}])
    nulls = [outcome(f"1-single-{k}-null") for k in range(40)]
    nulls[0] = replace(nulls[0], named=plain[1].named)
    several = [*plain, faint, *nulls]
    found = figure(several, "found, d_perp 8")
    assert (found.count, found.of, found.judged) == (39, 40, "met")
    assert figure(several, "found, d_perp 5").count == 0
    named = figure(several, f"a name on a null record: {nulls[0].null}")
    assert named.count == 1
    assert figure(several, "unknown or partial, though").count == 1
    assert figure(several, "share of the true gain, d_perp 8 to 15").value == pytest.approx(0.95)
    assert figure(several, "advice").value is None
    beside = [*plain[5].named, {**plain[5].named[0], "hidden": False}]
    several[5] = replace(plain[5], named=beside)
    assert figure(several, "a false name beside").count == 1
    late = {"kind": "x", "inside": True, "error": 0.01, "ramp": False}
    several[6] = replace(plain[6], onsets=[late, {**late, "inside": False, "ramp": True}])
    assert figure(several, "onset within its 90 % interval: a jump").value == 1
    assert figure(several, "onset within its 90 % interval: a ramp").value == 0
    lines = list(failures(several))
    assert sum(line.startswith("  1-single-5 ") for line in lines) == 1
    assert sum(line.startswith("  1-single-0 ") for line in lines) == 1
    assert sum(line.startswith("  1-single-0-null ") for line in lines) == 1


def test_an_interval_is_wilsons() -> None:
    one = rate("", [True] * 9 + [False], (0.85, 0.95), (0.88, 0.92))
    # Wilson (1927) by hand: n = 10, p = 0.9, z = 1.6449.
    assert (one.low, one.high) == pytest.approx((0.6523, 0.9773), abs=2e-3)
    assert one.judged == "few draws"
    assert rate("", [True] * 91 + [False] * 9, (0.85, 0.95), (0.88, 0.92)).judged == "aim"
    assert rate("", [True] * 94 + [False] * 6, (0.85, 0.95), (0.88, 0.92)).judged == "met"
    assert rate("", [True] * 100, (0.85, 0.95), (0.88, 0.92)).judged == "missed"


def test_tables_and_plots_are_made_of_any_part(tmp_path: Path) -> None:
    several = [outcome(one.id) for one in draws(1, 30, Draw)]
    for part in (several[:1], several[1:2], several):
        assert "found, d_perp 8 and more" in tables(part)
        for path in plot(part, tmp_path):
            assert path.stat().st_size > 10_000


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the draws that were judged, without diagnosing them."""
    names: list[str] = []

    def quick(draw: Draw) -> DrawOutcome:
        if len(names) == 3:
            raise KeyboardInterrupt
        names.append(draw.id)
        return outcome(draw.id)

    monkeypatch.setattr("rga_bench.diagnosis.experiment.judge", quick)
    return names


def test_an_interrupted_run_goes_on_where_it_was(tmp_path: Path, judged: list[str]) -> None:
    experiment, execution = DiagnosisExperiment(1, 4), Execution(folder=tmp_path)
    chosen = experiment.draws()
    with pytest.raises(KeyboardInterrupt):
        experiment.measure(execution)
    first = list(judged)
    with (tmp_path / NAME).open("a") as file:
        file.write('{"versions": {"rga"')
    judged.clear()
    with pytest.raises(KeyboardInterrupt):
        experiment.measure(execution)
    judged.clear()
    several = experiment.measure(execution)
    assert first == [one.id for one in chosen[:3]]
    assert judged == [one.id for one in chosen[6:]]
    assert several == [outcome(one.id) for one in chosen]
    assert len((tmp_path / NAME).read_text().splitlines()) == len(chosen)


def test_a_run_ends_in_time(judged: list[str]) -> None:
    with pytest.raises(InputError, match="no draw was finished"):
        DiagnosisExperiment(1, 4).measure(Execution(minutes=0.0))
    assert judged == []


def test_outcomes_of_other_code_are_not_mixed_in(tmp_path: Path) -> None:
    versions = task_versions(judge)
    Ledger(tmp_path, DrawOutcome, versions).add(outcome("1-single-0"))
    assert Ledger(tmp_path, DrawOutcome, versions).outcomes == {"1-single-0": outcome("1-single-0")}
    path = tmp_path / NAME
    text = path.read_text()
    path.write_text(text.replace('"rga": "', '"rga": "9.'))
    with pytest.raises(InputError, match=r"of another version: rga 9\.0"):
        Ledger(tmp_path, DrawOutcome, versions)
    for wrong in ("[]", "{}", "nonsense", '{"versions": 3}'):
        path.write_text(text + wrong + "\n")
        with pytest.raises(InputError, match="line 2"):
            Ledger(tmp_path, DrawOutcome, versions)
    with pytest.raises(InputError, match="cannot be kept"):
        Ledger(path, DrawOutcome, versions)


def test_a_case_is_drawn_and_written(rga: Any, tmp_path: Path) -> None:
    done = rga("benchmark", "diagnosis", "--case", "1-single-36", "-o", str(tmp_path / "case"))
    assert done.code == 0
    names = sorted(path.name for path in (tmp_path / "case").iterdir())
    assert names == ["model.json", "record.csv", "truth.json"]
    assert rga("benchmark", "diagnosis", "--case", "1-single-36").code == 2
    assert rga("benchmark", "diagnosis", "--case", "nobody", "-o", str(tmp_path)).code == 2
