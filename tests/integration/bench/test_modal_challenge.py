"""The blind challenge with modes: its physics, its draws, its judge and its tables."""

from dataclasses import replace
from math import gcd
from pathlib import Path

import numpy as np
import pytest

from independent.dense_modes import dense_mode_shapes
from rga.errors import InputError
from rga.model import load_model, read_model
from rga.records.modal.read import load_modal_record
from rga_bench.diagnosis.blind_draw import draws
from rga_bench.experiment import Execution
from rga_bench.field import STRUCTURES
from rga_bench.field.world import FieldWorld
from rga_bench.modal_diagnosis.design import BESIDE, CAMPAIGNS, ModalDraw
from rga_bench.modal_diagnosis.experiment import ModalDiagnosisExperiment
from rga_bench.modal_diagnosis.judge import ModalOutcome, judge_modes
from rga_bench.modal_diagnosis.tables import modal_figures, modal_tables
from rga_bench.swinging import OF_GAUGES, OF_MODES, Campaign, ModalCase, draw_modal
from rga_bench.swinging.masses import weigh
from rga_bench.swinging.vibration import SwingingWorld, vibrations

USUAL = Campaign()


def case(kind: str, campaign: Campaign = USUAL) -> ModalCase:
    return draw_modal(
        3, structure="portal", kind=kind, welded=False, campaign=campaign, beside=False
    )


@pytest.mark.parametrize("structure", STRUCTURES)
def test_a_structure_swings_as_textbook_matrices_say(structure: str) -> None:
    place = STRUCTURES[structure](np.random.default_rng(2))
    masses = weigh(place, np.random.default_rng(2))
    found = vibrations(SwingingWorld(FieldWorld.of(place), masses), 4)
    expected, _ = dense_mode_shapes(read_model(place.model, structure), 60)
    # Members that swing between nodes that stand still are passed over.
    for frequency in found.frequencies:
        assert np.abs(expected / frequency - 1.0).min() < 1e-3


def test_the_same_seed_gives_the_same_bits_and_twins_differ_by_what_is_hidden_alone() -> None:
    one, again, twin = case("member_stiffness"), case("member_stiffness"), case("null")
    assert one.modal == again.modal
    assert one.truth["kind"] == "member_stiffness"
    assert one.truth["stiffness"] == twin.truth["stiffness"]
    np.testing.assert_array_equal(np.isnan(one.frequency), np.isnan(twin.frequency))
    assert not np.allclose(one.frequency, twin.frequency, rtol=1e-3, equal_nan=True)


@pytest.mark.parametrize("beside", [False, True])
def test_a_case_is_what_its_files_say(beside: bool, tmp_path: Path) -> None:
    drawn = draw_modal(
        4, structure="portal", kind="mass_factor", welded=True,
        campaign=Campaign(weather=not beside), beside=beside,
    )  # fmt: skip
    drawn.write(tmp_path)
    model = load_model(tmp_path / "model.json")
    record = load_modal_record(tmp_path / "modes.csv", model)
    assert len(record) == np.isfinite(drawn.frequency).sum()
    assert (tmp_path / "record.csv").exists() is beside
    assert ("air" in record.contexts) is not beside


def test_weather_and_a_wrong_clock_move_all_frequencies() -> None:
    usual, fast = case("null"), case("null", Campaign(clock=1.01))
    np.testing.assert_allclose(fast.frequency, 1.01 * usual.frequency, rtol=1e-9)
    cold = case("null", Campaign(weather=True)).frequency
    assert np.nanstd(np.log(cold[:, 0])) > 2.0 * np.nanstd(np.log(usual.frequency[:, 0]))


def test_draws_are_known_by_their_names_and_every_kind_meets_every_campaign() -> None:
    drawn = draws(7, 30, ModalDraw)
    assert all(ModalDraw.parse(one.id) == one for one in drawn)
    assert gcd(len(OF_MODES), len(CAMPAIGNS)) == 1
    assert gcd(len(OF_MODES) + len(OF_GAUGES), len(BESIDE)) == 1
    assert sum(one.null for one in drawn) == len(drawn) // 2 == 30
    with pytest.raises(InputError, match="names no case of the challenge"):
        ModalDraw.parse("7-single-1")


@pytest.fixture(scope="module")
def outcome() -> ModalOutcome:
    """Of a weak member of a plane frame."""
    drawn = next(
        one for one in draws(3, 200, ModalDraw)
        if one.structure == "portal" and one.kind == "member_stiffness" and one.stratum == "modal"
    )  # fmt: skip
    return judge_modes(drawn)


def test_a_weak_member_is_judged(outcome: ModalOutcome) -> None:
    assert outcome.hidden is not None
    assert outcome.among == any(one["hidden"] for one in outcome.named)
    assert outcome.mispaired == 0 < outcome.paired
    assert outcome.hidden["d_perp"] is None or outcome.hidden["d_perp"] > 0.0


def test_tables_tell_what_was_found_and_what_was_not(outcome: ModalOutcome) -> None:
    hidden = outcome.hidden
    assert hidden is not None
    named = {"kind": "clock_rate", "onset": None, "log_odds": 9.0, "rivals": 0, "hidden": False}
    found = replace(outcome, found=True, among=True, hidden={**hidden, "d_perp": 12.0})
    wrong = replace(found, found=False, among=False, verdict="named", named=[named])
    twin = replace(outcome, id=outcome.id + "-null", hidden=None, found=False, named=[named])
    several = {one.name: one for one in modal_figures([found, wrong, twin])}
    assert several["modes alone, found, d_perp 8 and more"].value == 0.5
    assert several["modes alone, named wrongly"].value == 0.5
    assert several["modes alone, a name on a null twin"].value == 1.0
    *_, failures = modal_tables([found, wrong, twin])
    assert [row[3] for row in failures.rows] == ["clock_rate  (9, 0 rivals)"] * 2


def test_the_experiment_goes_on_with_what_is_done(tmp_path: Path, outcome: ModalOutcome) -> None:
    experiment = ModalDiagnosisExperiment.of(3, quick=True, count=400)
    assert len(experiment.draws()) == 8
    with pytest.raises(InputError, match="no draw was finished"):
        experiment.measure(Execution(tmp_path, 1, None, 0.0))
    page = experiment.page([outcome], "rga benchmark modal-diagnosis").text()
    assert "| modes alone, named wrongly |" in page
    assert outcome.id in str(experiment.content([outcome], ""))
