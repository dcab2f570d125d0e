"""`rga modes`: frequencies, which mode is which, and those that were measured."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import rga as package
from independent.mixed_bridge import mixed
from independent.modal_bridge import Hidden, measured
from rga.model.io import model_content, write_model
from rga.records.modal.record import ModalRecord


def expected(way: str, sizes: dict[int, float]) -> dict[str, Any]:
    shape = {f"{way}{at}": size for at, size in sizes.items()}
    shape |= {f"{other}{at}": 0.0 for other in "XY" if other != way for at in sizes}
    return {"near": 2.0, "within": 0.5, "shape": shape}


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    """A column on a stiff foot, sway in both directions expected by shape."""
    build = package.ModelBuilder("mast").add_material("steel", E=210e9, density=7850)
    build.add_section("tube", A=8e-3, Iy=2e-5, Iz=6e-5, J=4e-5)
    for at in range(4):
        build.add_node(f"n{at}", z=2.0 * at)
        if at:
            build.add_member(f"n{at - 1}", f"n{at}", "tube", kind="frame")
    build.support("n0", "fixed").mass("n3", 400)
    content: dict[str, Any] = model_content(build.build())
    shape = {1: 0.15, 2: 0.52, 3: 1.0}
    content["points"] = {
        f"{way}{at}": {"node": f"n{at}", "direction": direction}
        for way, direction in (("X", [1, 0, 0]), ("Y", [0, 1, 0]))
        for at in shape
    }
    content["modes"] = {f"sway {way}": expected(way, shape) for way in "XY"}
    path = tmp_path / "mast.json"
    path.write_text(json.dumps(content))
    return path


def test_frequencies_and_the_mode_of_each_name(rga: Callable[..., Any], mast: Path) -> None:
    done = rga("modes", mast, "--count", 4)
    assert done.code == 0
    assert "Mass that moves along x, y, z: 0.7768, 0.7768, 0.7768 t" in done.out
    lines = {line.split("  ")[0]: line.split() for line in done.out.splitlines()}
    assert {lines["sway X"][3], lines["sway Y"][3]} == {"1", "2"}
    assert float(lines["sway X"][-1]) > 0.99


def test_content_and_shapes(rga: Callable[..., Any], mast: Path, tmp_path: Path) -> None:
    shapes = tmp_path / "shapes.csv"
    done = rga("modes", mast, "--count", 3, "--json", "-", "-o", shapes)
    content = json.loads(done.out)
    assert [one["mode"] for one in content["modes"]] == [1, 2, 3]
    assert content["model"]["sha256"] == package.load_model(mast).sha256
    frame = pl.read_csv(shapes)
    assert frame.shape == (3 * 4 * 6, 4)
    found = package.modes(mast, 3)
    np.testing.assert_allclose(frame["value"].to_numpy(), found.shapes.ravel())


def test_measured_modes_get_their_names(
    rga: Callable[..., Any], mast: Path, tmp_path: Path
) -> None:
    record = tmp_path / "modes.csv"
    columns = [f"{way}{at}" for way in "XY" for at in (1, 2, 3)]
    lines = ["time,f," + ",".join(columns)]
    lines += [f"2026-03-01T12:{10 * k}:00,2.1,0,0,0,0.3,1.0,2.0" for k in range(1, 4)]
    lines += ["2026-03-01T12:10:00,1.9,-0.1,-0.5,-1,0,0,0", "2026-03-01T12:10:00,9,1,1,-1,0,0,0"]
    record.write_text("\n".join(lines) + "\n")
    done = rga("modes", mast, record)
    assert done.code == 0
    measured = done.out[done.out.index("measured") :].splitlines()
    assert measured[1].split()[:5] == ["sway", "X", "2.0000", "33.3", "1.9000"]
    assert measured[2].split()[:5] == ["sway", "Y", "2.0000", "100.0", "2.1000"]
    assert "3 windows, 5 modes found in them, 1 of which" in measured[3]
    content = json.loads(rga("modes", mast, record, "--json", "-").out)
    assert [one["found"] for one in content["measured"]] == pytest.approx([1 / 3, 1.0])


def test_what_modes_hardly_look_like_is_told(rga: Callable[..., Any], mast: Path) -> None:
    content = json.loads(mast.read_text())
    content["points"] = {name: one for name, one in content["points"].items() if name[0] == "X"}
    sway = {"near": 2.0, "within": 0.5}
    content["modes"] = {name: {**sway, "computed": k} for name, k in (("A", 1), ("B", 2))}
    mast.write_text(json.dumps(content))
    done = rga("modes", mast)
    assert done.out.count("by frequency only") == 1
    assert "No point sees mode B: all stand still in it" in done.out
    content["modes"]["C"] = content["modes"]["A"]
    mast.write_text(json.dumps(content))
    assert "Modes A and C cannot be told apart" in rga("modes", mast).out


def test_a_record_needs_modes_that_are_expected(
    rga: Callable[..., Any], mast: Path, tmp_path: Path
) -> None:
    content = json.loads(mast.read_text())
    del content["modes"]
    mast.write_text(json.dumps(content))
    record = tmp_path / "modes.csv"
    record.write_text("time,f\n0,2.0\n")
    done = rga("modes", mast, record)
    assert done.code == 2
    assert "no mode is expected" in done.err


@pytest.mark.parametrize("count", ["0", "1001", "many"])
def test_counts_that_are_none(rga: Callable[..., Any], mast: Path, count: str) -> None:
    done = rga("modes", mast, "--count", count)
    assert done.code == 2
    assert "Traceback" not in done.err


def written_modes(modal: ModalRecord) -> str:
    """Modes as the long table of a file."""
    lines = [",".join(["time", "f", *modal.points])]
    rows = zip(modal.time, modal.frequency, modal.shapes, strict=True)
    lines += [",".join(map(repr, map(float, [time, f, *shape]))) for time, f, shape in rows]
    return "\n".join(lines) + "\n"


def test_a_record_and_modes_are_diagnosed_together(rga: Callable[..., Any], tmp_path: Path) -> None:
    model, record, modal = mixed(0, Hidden())
    write_model(model, tmp_path / "model.json")
    record.write(tmp_path / "record.csv")
    (tmp_path / "modes.csv").write_text(written_modes(modal))
    files = tmp_path / "model.json", tmp_path / "record.csv", "--modal", tmp_path / "modes.csv"
    done = rga("diagnose", *files, "-o", tmp_path / "found")
    assert done.code == 0, done.err
    assert "Verdict: nothing_wrong" in done.out
    findings = json.loads((tmp_path / "found" / "findings.json").read_text())
    assert findings["modal_sha256"] not in (None, findings["record_sha256"])
    assert findings["windows"]["count"] == 40
    assert findings["windows"]["modes"]["m0"].keys() >= {"frequency", "scatter", "memory", "shape"}
    assert {"f m0", "D b1n"} <= findings["gap"]["by_sensor"].keys()
    report = (tmp_path / "found" / "report.html").read_text()
    assert "<h2>Modes</h2>" in report
    assert "Measured over simulated" in report


def test_a_table_of_modes_is_no_record(rga: Callable[..., Any], tmp_path: Path) -> None:
    model, record = measured(0, Hidden())
    write_model(model, tmp_path / "model.json")
    (tmp_path / "modes.csv").write_text(written_modes(record))
    files = tmp_path / "model.json", tmp_path / "modes.csv"
    done = rga("diagnose", *files, "-o", tmp_path / "found")
    assert done.code == 2
    assert "Give it as --modal" in done.err


def test_modes_that_decide_nothing_speak_against_nothing(
    rga: Callable[..., Any], tmp_path: Path
) -> None:
    model, record = measured(0, Hidden(), modes=2)
    write_model(model, tmp_path / "model.json")
    (tmp_path / "modes.csv").write_text(written_modes(record))
    files = tmp_path / "model.json", "--modal", tmp_path / "modes.csv"
    done = rga("diagnose", *files, "-o", tmp_path / "found")
    assert done.code == 0, done.err
    assert "Nothing speaks against the model, and these data cannot decide" in done.out
    assert "m0 and m1 alone were found, and 3 are needed" in done.out
    report = (tmp_path / "found" / "report.html").read_text()
    assert "These data cannot decide" in report
    assert "Cause not known" not in report


def test_nothing_to_diagnose_is_refused(
    rga: Callable[..., Any], mast: Path, tmp_path: Path
) -> None:
    done = rga("diagnose", mast, "-o", tmp_path / "found")
    assert done.code == 2
    assert "there is nothing to compare the model with" in done.err


@pytest.mark.parametrize("onset", [90, 120])
def test_modes_are_watched_and_diagnosed(
    rga: Callable[..., Any], tmp_path: Path, onset: int
) -> None:
    """A change at the ninetieth window of 120, and none."""
    hidden = Hidden(stiffness={"bottom bracing": 0.7}, onset=onset)
    model, record = measured(2, hidden, modes=4, windows=120)
    write_model(model, tmp_path / "model.json")
    (tmp_path / "modes.csv").write_text(written_modes(record))
    (tmp_path / "settings.toml").write_text("calibration_rows = 70\narl0 = 5000\n")
    files = tmp_path / "model.json", "--modal", tmp_path / "modes.csv"
    chosen = "--settings", tmp_path / "settings.toml"
    done = rga("run", *files, *chosen, "-o", tmp_path / "out")
    assert done.code == 0, done.err
    assert "window 69  calibration: 70 windows say what is usual" in done.out
    findings = json.loads((tmp_path / "out" / "findings.json").read_text())
    told = [one for one in findings["warnings"] if one.startswith("out of sync: a step since")]
    if onset == 120:
        assert "no alarm" in done.out
        assert not told
        assert findings["verdict"] == "nothing_wrong"
    else:
        assert "alarm: out of sync: a step since" in done.out
        assert len(told) == 1
        assert findings["verdict"] != "nothing_wrong"
    assert "<h2>Modes</h2>" in (tmp_path / "out" / "report.html").read_text()


def test_what_cannot_be_watched_is_refused(
    rga: Callable[..., Any], mast: Path, tmp_path: Path
) -> None:
    modes = tmp_path / "modes.csv"
    modes.write_text("time,f\n" + "".join(f"{at},2.0\n" for at in range(20)))
    out = "-o", tmp_path / "out"
    for arguments, words in (
        ((), "there is nothing to watch"),
        ((modes, "--modal", modes), "one record is watched in a run"),
        (("--modal", modes, "--level", "B"), "setting 'level' says nothing of modes"),
        (("--modal", modes, "--import", modes), "--import says nothing of modes"),
        (("--modal", modes), "the monitor needs 30"),
    ):
        done = rga("run", mast, *arguments, *out)
        assert done.code == 2, arguments
        assert words in done.err


def test_a_context_that_drives_the_structure_is_asked_for_by_its_option(
    rga: Callable[..., Any], mast: Path
) -> None:
    content = json.loads(mast.read_text())
    content["context"] = {"stiff": {"unit": "-", "range": [0.5, 2.0]}}
    factor = {"context": "stiff"}
    soft = {"kind": "elastic_modulus", "material": "steel", "factor": factor}
    content["effects"] = {"soft": soft}
    mast.write_text(json.dumps(content))
    done = rga("modes", mast)
    assert done.code == 2
    assert "the context 'stiff' is missing" in done.err
    assert "--contexts stiff=" in done.err
    assert rga("modes", mast, "--contexts", "stiff=1").code == 0
