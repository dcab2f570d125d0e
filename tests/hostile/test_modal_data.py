"""Modes that cannot be what they are given as: a clear error, or a word; never a wrong number."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hostile.modal_data import POINTS, first, model, table
from independent.mixed_bridge import mixed
from independent.modal_bridge import Hidden
from rga.model.io import write_model

Given, Judged, Rga = Callable[..., Any], Callable[[Any], Any], Callable[..., Any]
COMMANDS = (
    ("modes", "{}/mast.json", "{}/modes.csv"),
    ("diagnose", "{}/mast.json", "--modal", "{}/modes.csv", "-o", "{}/out"),
)
#: with wrong values at a place, and what is told of them
MODELS: dict[str, tuple[bytes, str]] = {
    "no mass of a node": (model("masses", "head", value={"node": "n3"}), "masses.head"),
    "negative mass": (model("masses", "head", "mass", value=-400), "masses.head.mass"),
    "mass that is no number": (model("masses", "head", "mass", value=float("nan")), "finite"),
    "negative density": (model("materials", "steel", "density", value=-1), "density"),
    "a shape where no point is": (model("modes", "m0", "shape", "Z9", value=1.0), "'Z9'"),
    "a point where no node is": (model("points", "X1", "node", value="n9"), "'n9'"),
    "a shape of zero": (
        model("modes", "m0", "shape", value=dict.fromkeys(POINTS, 0.0)),
        "the shape is zero at every point",
    ),
    "no frequency that is expected": (model("modes", "m0", "near", value=0.0), "modes.m0.near"),
    "no modes": (model("modes", value={}), "no mode is expected"),
}
#: tables of modes, and what is told of them
TABLES: dict[str, tuple[bytes, str]] = {
    "a unit at one point": (table(columns=("X1 [mm]", *POINTS[1:])), "'X1' is in mm and 'X2' in"),
    "two units": (
        table(columns=("X1 [mm]", *(f"{one} [m]" for one in POINTS[1:]))),
        "'X1' is in mm and 'X2' in m",
    ),
    "rad/s by its header": (table(header="time,f [rad/s]"), "the unit of 'f' is 'rad/s'"),
    "rad/s by its values": (table(lambda f: 2 * np.pi * f), "they look like rad/s"),
    "cycles per minute": (table(lambda f: 60 * f), "they look like cycles per minute"),
    "a sixtieth": (table(lambda f: f / 60), "they look like Hz divided by 60"),
    "kHz": (table(lambda f: 1e-3 * f), "they look like kHz"),
    "periods": (table(lambda f: 1 / f), "none of the modes that the model expects"),
    "normalised by the first": (table(lambda f: f / first()), "0.574 times as fast"),
    "normalised to scores": (table(lambda f: f / 9.0 - 1.0), "not normalised"),
    "normalised, by its name": (table(header="time,f_norm"), "there is no column 'f'"),
    "no column of time": (table(header="when,f"), "there is no column 'time'"),
    "all missing": (table(windows=0), "give at least one row"),
    "no frequency": (table(lambda f: float("nan")), "there is no frequency"),
    "no frequency in a wide table": (b"time,m0,m1\n0,,\n600,,\n", "no mode was found"),
    "a time that is none": (
        b"\n".join(
            line.replace(line.split(b",")[0], b"2026-13-45T00:00:00") if number == 4 else line
            for number, line in enumerate(table().split(b"\n"))
        ),
        "modes.csv, line 5",
    ),
    "two lines of a time": (
        b"time,m0,m1,m2\n0,1.7,2.9,19\n0,1.8,2.9,19\n",
        "two lines have the same time",
    ),
    "shapes of zero": (table(shape=lambda s: [0.0] * 6), "in 80 of 80 lines"),
    "shapes next to zero": (table(shape=lambda s: [1e-200 * x for x in s]), "zero at every point"),
    "an infinite shape": (table(shape=lambda s: ["inf", *s[1:]]), "infinite"),
    "sizes without signs": (table(shape=lambda s: [abs(x) for x in s]), "and no signs"),
    "sizes and phases": (
        table(shape=lambda s: [abs(x) for x in s], X1_phase=lambda mode: 0.1),
        "give real parts in X1 and imaginary parts in X1_im",
    ),
    "complex numbers in a cell": (
        table(shape=lambda s: [f"({x:.4f}{0.1 * x:+.4f}j)" for x in s]),
        "is a complex number",
    ),
    "an imaginary part alone": (table(columns=("X1_im", *POINTS[1:])), "and there is no 'X1'"),
    "imaginary parts of some": (table(X1_im=lambda mode: 0.01), "there is no column 'X2_im'"),
    "two temperatures of a window": (table(air=lambda mode: 5 * mode), "of the same window"),
    "a duration below zero": (table(duration=lambda mode: -600), "not above zero"),
}
BAD = MODELS | TABLES
#: tables that are used, and the word that says how
TOLD: dict[str, tuple[bytes, str]] = {
    "points of another model": (
        table(columns=tuple(f"A{k}" for k in range(6))),
        "paired by frequency only, without a shape: m0, m1, m2, m3",
    ),
    "a point of another model": (
        table(columns=("A1", *POINTS[1:])),
        "columns that are not used: A1",
    ),
    "no shapes": (table(shape=lambda s: [None] * 6), "paired by frequency only"),
    "lines twice": (
        table() + b"".join(table().splitlines(keepends=True)[1:]),
        "80 entries stand in the record more than once: each counts once",
    ),
    "one window": (table(windows=1), "how the frequencies of m0, m1, m2, m3 scatter is assumed"),
    "a temperature of another scale": (table(air=lambda mode: 290), "check its unit and its zero"),
}


@pytest.mark.parametrize("command", COMMANDS, ids=["modes", "diagnose"])
@pytest.mark.parametrize("name", [*MODELS, *TABLES])
def test_what_cannot_be_meant_is_refused_in_a_line(
    given: Given, judged: Judged, name: str, command: tuple[str, ...]
) -> None:
    spoiled, told = BAD[name]
    files = {"mast.json": model(), "modes.csv": table()}
    files["mast.json" if name in MODELS else "modes.csv"] = spoiled
    came = judged(given(command, files))
    assert came.code == 2
    assert came.faults == []
    assert told in came.said


@pytest.mark.parametrize("name", TOLD)
def test_what_is_used_is_told(
    given: Given, judged: Judged, without_reports: None, name: str
) -> None:
    spoiled, told = TOLD[name]
    for command in COMMANDS:
        came = judged(given(command, {"mast.json": model(), "modes.csv": spoiled}))
        assert (came.code, came.faults) == (0, [])
    assert told in came.said


def test_of_a_sound_table_nothing_is_said(
    given: Given, judged: Judged, without_reports: None
) -> None:
    case = given(COMMANDS[1], {"mast.json": model(), "modes.csv": table()})
    came = judged(case)
    assert (came.code, came.faults, came.said) == (0, [], "")
    findings = json.loads((case.output / "findings.json").read_text())
    assert findings["verdict"] == "nothing_wrong"


def test_a_structure_without_any_mass_has_no_modes(given: Given, judged: Judged) -> None:
    content = json.loads(model("masses", value={}))
    content["materials"]["steel"]["density"] = 0.0
    weightless = json.dumps(content).encode()
    for command in COMMANDS:
        came = judged(given(command, {"mast.json": weightless, "modes.csv": table()}))
        assert (came.code, came.faults) == (2, [])
        assert "nothing that can move has a mass" in came.said


@pytest.mark.parametrize("late", [0.0, 3e7])
def test_clocks_that_have_no_time_in_common_are_told(
    rga: Rga, tmp_path: Path, without_reports: None, late: float
) -> None:
    structure, record, modal = mixed(0, Hidden())
    write_model(structure, tmp_path / "model.json")
    record.write(tmp_path / "record.csv")
    lines = [",".join(["time", "f", *modal.points])]
    for time, f, shape in zip(modal.time / 20 + late, modal.frequency, modal.shapes, strict=True):
        lines.append(",".join(map(repr, map(float, [time, f, *shape]))))
    (tmp_path / "modes.csv").write_text("\n".join(lines))
    files = tmp_path / "model.json", tmp_path / "record.csv", "--modal", tmp_path / "modes.csv"
    done = rga("diagnose", *files, "-o", tmp_path / "out")
    assert done.code == 0
    assert ("no time in common, 347 days lie between them" in done.err) == bool(late)


def test_dates_beside_seconds_are_refused(rga: Rga, tmp_path: Path) -> None:
    structure, record, _ = mixed(0, Hidden())
    write_model(structure, tmp_path / "model.json")
    record.write(tmp_path / "record.csv")
    (tmp_path / "modes.csv").write_text("time,f\n2026-03-01T12:00,4.9\n2026-03-01T12:10,4.9\n")
    files = tmp_path / "model.json", tmp_path / "record.csv", "--modal", tmp_path / "modes.csv"
    done = rga("diagnose", *files, "-o", tmp_path / "out")
    assert done.code == 2
    assert "dates stand in the modes alone: the two clocks cannot be compared" in done.err
