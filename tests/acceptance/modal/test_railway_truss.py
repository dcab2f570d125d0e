"""A measured railway bridge: a train crosses it, and what swings behind the train is its modes.

The model in space, `railway_truss`, is compared with the trusses in their planes and with figures
that the shared data and the owner of the record state. Nothing tells the diagnosis what to find.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import Outcome
from findings_invariants import check_invariants
from railway_truss import railway_truss
from rga.arrays import FloatArray
from rga.diagnosis import diagnose
from rga.findings import Findings
from rga.model import Model, load_model, read_effect
from rga.model.mass_budget import mass_budget
from rga.records import load_record
from rga.simulation import Simulator
from rga.simulation.modal.analysis import modes

EXAMPLE = Path(__file__).parents[3] / "examples" / "rdso45m"
DATA = Path(__file__).parents[4] / "shared" / "measured" / "rdso45m"
RECORD = DATA / "record_40kmh.txt"
#: the last axle has left by then [s from the first row], and gauges that show how the bridge swings
LEFT = "31"
GAUGES = [f"S{number} (m/m)" for number in (*range(21, 33), *range(34, 41))]
FLOOR = {"floor_participation", "added_axial_area"}
#: the train changes little between rows that are so far apart
APART = 24
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="the shared measurements are not here")


@cache
def plane() -> Model:
    return load_model(EXAMPLE / "model.json")


@cache
def space() -> Model:
    return railway_truss(DATA, plane())


def changed(kind: str, **keys: Any) -> Model:
    return space().extended({"what is looked at": read_effect({"kind": kind, **keys}, "test")})


def lateral_and_vertical(model: Model) -> tuple[float, float]:
    """Frequencies of the modes in which the trusses move to one side, and up together [Hz]."""
    found = modes(model, 12)
    at = list(model.nodes).index("2.U4")
    moving = np.abs(found.shapes[:, at])
    middle = moving.max(axis=1) > 0.5 * moving.max()
    sideways = moving[:, 1] > moving[:, 2]
    lateral = found.frequencies[middle & sideways][0]
    return float(lateral), float(found.frequencies[middle & ~sideways][0])


def crossing(model: Model) -> FloatArray:
    return Simulator(model).predict({"train": np.linspace(0.0, 134.0, 40)})


def test_it_weighs_what_the_owner_of_the_record_says() -> None:
    kilograms = sum(line.members + line.beside for line in mass_budget(space()))
    assert kilograms == pytest.approx(120e3, rel=0.05)


def test_frequencies_are_those_of_the_design_without_and_with_the_floor() -> None:
    np.testing.assert_allclose(lateral_and_vertical(space()), [3.03, 5.24], rtol=0.04)
    tied = changed("added_axial_area", group="bottom chord", area=0.61 * 0.021)
    np.testing.assert_allclose(lateral_and_vertical(tied), [3.18, 5.59], rtol=0.05)
    stiffer = changed("elastic_modulus", material="steel", factor=1.21)
    np.testing.assert_allclose(lateral_and_vertical(stiffer), [3.33, 5.77], rtol=0.04)


def test_without_laterals_its_statics_are_those_of_the_trusses_in_their_planes() -> None:
    """Laterals between the bottom chords share a sixteenth of their force; stiff joints relieve
    hangers, which S23 and S31 are on."""
    largest = np.abs(crossing(plane())).max(axis=0)
    hangers = np.isin(list(plane().sensors), ["S23", "S31"])
    loose = np.abs(crossing(changed("member_stiffness", group="laterals", factor=1e-3))).max(axis=0)
    np.testing.assert_allclose(loose[~hangers], largest[~hangers], rtol=0.02)
    np.testing.assert_allclose(np.abs(crossing(space())).max(axis=0), largest, rtol=0.1)


def kinds(findings: Findings, number: int) -> set[str]:
    """Of a cause, and of what the data cannot separate from it."""
    cause = findings.causes[number]
    return {str(one["kind"]) for one in (cause.effect, *cause.rivals)}


@pytest.fixture
def behind_the_train(rga: Callable[..., Outcome], tmp_path: Path) -> Path:
    """The modes that the free vibration shows, as `rga free-decay` writes them."""
    written = tmp_path / "modes.csv"
    columns = [f"{point} (mm)={point}" for point in ("d5", "d6", "d7")]
    chosen = [word for one in (*columns, *GAUGES) for word in ("--column", one)]
    done = rga("free-decay", RECORD, "--highest", "8", "--from", LEFT, *chosen, "-o", written)
    assert done.code == 0, done.err
    return written


@pytest.mark.thorough
def test_modes_add_what_is_lateral_and_leave_what_the_gauges_say(behind_the_train: Path) -> None:
    record = load_record(RECORD, space(), EXAMPLE / "import.toml").rows(slice(0, None, APART))
    findings = diagnose(space(), record, modal=behind_the_train)
    check_invariants(findings)
    assert findings.verdict == "partial"
    broken, floor, lateral = findings.causes
    assert broken.effect["sensor"] == "S33"
    # The floor carries a share of the bottom chord's force: which part of it is open, as before.
    assert kinds(findings, 1) <= FLOOR
    places = {one["group"] for one in (floor.effect, *floor.rivals)}
    assert places <= {"bottom chord", "stringers"}
    # What is lateral shows in the modes alone and stays open: no modulus, mass or clock.
    assert "lateral" in lateral.why
    assert lateral.status == "ambiguous"
    assert kinds(findings, 2) == {"support_flexibility"}
    directions = {one["dof"] for one in (lateral.effect, *lateral.rivals)}
    assert "uy" in directions
    assert "uz" not in directions
    # No cause moves d7 as it was measured, which is told.
    assert "the shape of mode lateral" in findings.unexplained.looks_like
