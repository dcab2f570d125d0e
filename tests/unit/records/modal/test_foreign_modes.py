"""Modes as other programs write them, in files that are made with plain libraries."""

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.io import savemat

import rga
from rga.errors import InputError
from rga.model import Model
from rga.records.modal.read import load_modal_record
from unit.records.modal.conftest import POINTS

FN, XI, FN_STD = np.array([4.1, 7.3]), np.array([0.01, 0.02]), np.array([0.03, 0.05])
PHI = np.array([[0.3, -0.4], [0.1, 0.0], [1.0, 1.0], [0.3, 0.0]])
#: the same with a phase of its own for each mode
TURNED = PHI * np.exp([0.4j, -1.1j])

Writer = Callable[[Path, dict[str, Any]], Path]


def as_numpy(folder: Path, arrays: dict[str, Any]) -> Path:
    np.savez_compressed(folder / "modes.npz", **arrays)
    return folder / "modes.npz"


def as_matlab(folder: Path, arrays: dict[str, Any]) -> Path:
    kept = {name: one for name, one in arrays.items() if name != "points"}
    savemat(folder / "modes.mat", {"result": kept})
    return folder / "modes.mat"


def as_json(folder: Path, arrays: dict[str, Any]) -> Path:
    parts = dict(arrays)
    if np.iscomplexobj(parts.get("Phi")):
        parts |= {"Phi": parts["Phi"].real, "Phi_im": parts["Phi"].imag}
    content = {name: np.asarray(one).tolist() for name, one in parts.items()}
    (folder / "modes.json").write_text(json.dumps(content), encoding="utf-8")
    return folder / "modes.json"


def proportional(found: np.ndarray, expected: np.ndarray) -> bool:
    """Whether shapes are the same but for their scale and sign."""
    alike = np.abs((found * expected).sum(1)) ** 2
    return np.allclose(alike, (found**2).sum(1) * (expected**2).sum(1))


@pytest.mark.parametrize("written", [as_numpy, as_matlab, as_json])
@pytest.mark.parametrize("shapes", [PHI, TURNED])
def test_results_of_pyoma2(
    tmp_path: Path, mast: Model, written: Writer, shapes: np.ndarray
) -> None:
    arrays = {"Fn": FN, "Xi": XI, "Phi": shapes, "Fn_std": FN_STD, "points": list(POINTS)}
    record = load_modal_record(written(tmp_path, arrays), mast)
    assert record.frequency.tolist() == FN.tolist()
    assert record.damping.tolist() == XI.tolist()
    assert record.frequency_sd.tolist() == FN_STD.tolist()
    assert record.time.tolist() == [0.0, 0.0]
    if written is as_matlab:  # it holds no words
        assert record.points == ()
        assert {"channel_1", "channel_4"} <= set(record.left_out)
        return
    assert record.points == POINTS
    assert proportional(record.shapes, PHI.T)
    assert record.realness.tolist() == pytest.approx([1.0, 1.0])


@pytest.mark.parametrize("written", [as_numpy, as_json])
def test_several_windows_of_which_one_lacks_a_mode(
    tmp_path: Path, mast: Model, written: Writer
) -> None:
    arrays = {
        "Fn": [[4.1, 7.3], [np.nan, 7.4]],
        "Phi": np.stack([PHI, PHI]),
        "points": POINTS,
        "time": ["2026-03-01T12:00:00", "2026-03-01T12:10:00"],
        "duration": 600.0,
    }
    record = load_modal_record(written(tmp_path, arrays), mast)
    assert record.frequency.tolist() == [4.1, 7.3, 7.4]
    assert (record.start, record.time.tolist()) == ("2026-03-01T12:00:00", [0.0, 0.0, 600.0])
    assert record.duration.tolist() == [600.0] * 3
    assert proportional(record.shapes, PHI.T[[0, 1, 1]])


def test_a_result_in_memory_is_what_its_file_is(tmp_path: Path, mast: Model) -> None:
    result = SimpleNamespace(Fn=FN, Xi=XI, Phi=TURNED, Fn_std=None)
    record = rga.modal_record(
        [result, {"Fn": FN[:1] + 0.1, "Phi": PHI[:, :1]}],
        mast,
        POINTS,
        time=["2026-03-01T12:00:00", "2026-03-01T12:10:00"],
        duration=600.0,
    )
    assert record.frequency.tolist() == [4.1, 7.3, pytest.approx(4.2)]
    assert record.damping[:2].tolist() == XI.tolist()
    assert np.isnan(record.damping[2])
    assert record.time.tolist() == [0.0, 0.0, 600.0]
    assert proportional(record.shapes, PHI.T[[0, 1, 0]])
    other = rga.modal_record([result], mast, POINTS, time=[3.0])
    assert other.start == 3.0
    assert other.sha256 != record.sha256


class Rebuilt:
    """What Python would rebuild by running something."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (pytest.fail, ("the file was unpickled",))


@pytest.mark.parametrize(
    ("arrays", "told"),
    [
        ({"Fn": []}, "Fn has the dimensions 1 x 0"),
        ({"Fn": [np.nan, np.nan]}, "no mode was found in any window"),
        ({"Fn": [-0.2, 7.0]}, "-0.2 Hz is no natural frequency"),
        ({"Fn": [np.inf, 7.0]}, "the value is infinite"),
        ({"Fn": ["x", "y"]}, "Fn holds no numbers"),
        ({"Fn": np.array([4.0 + 1j])}, "Fn holds no numbers"),
        ({"Fn": FN, "Xi": [0.1]}, "Xi has the dimensions 1"),
        ({"Fn": FN, "Phi": np.ones((4, 3))}, "Phi has the dimensions 4 x 3"),
        ({"Fn": FN, "Phi": PHI, "points": ["a"]}, "there are 1 points, and Phi has 4 channels"),
        ({"Fn": FN, "Phi": PHI, "points": ["a", "b", "a", "c"]}, "'a' has the name of another"),
        ({"Fn": FN, "Phi": PHI, "points": ["a", "b", "f", "c"]}, "'f' has the name of another"),
        ({"Fn": FN, "Phi_im": PHI}, "there is Phi_im and no Phi"),
        ({"Fn": [FN, FN]}, "there are 2 windows, and no time"),
        ({"Fn": [FN, FN], "time": [1.0]}, "time has 1 values, and there are 2 windows"),
        ({"Fn": np.array([Rebuilt()])}, "the arrays cannot be read"),
    ],
)
def test_arrays_that_cannot_be_meant(
    tmp_path: Path, mast: Model, arrays: dict[str, Any], told: str
) -> None:
    np.savez(tmp_path / "modes.npz", **arrays)
    with pytest.raises(InputError) as refused:
        load_modal_record(tmp_path / "modes.npz", mast)
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("results", "times", "told"),
    [
        (SimpleNamespace(Fn=None, Phi=None), 0.0, "has no Fn"),
        ({"Xi": XI}, 0.0, "has no Fn"),
        ([{"Fn": FN}], [1.0, 2.0], "there are 1 results and 2 times"),
        ([], [], "there is no result"),
    ],
)
def test_results_that_cannot_be_meant(mast: Model, results: Any, times: Any, told: str) -> None:
    with pytest.raises(InputError, match=told):
        rga.modal_record(results, mast, POINTS, time=times)


def test_other_packed_files_are_no_results(tmp_path: Path, mast: Model) -> None:
    np.savez(tmp_path / "other.npz", a=FN)
    with pytest.raises(InputError):
        load_modal_record(tmp_path / "other.npz", mast)


def test_a_wide_table_is_read_by_modes_or_by_numbers(tmp_path: Path, mast: Model) -> None:
    file = tmp_path / "wide.csv"
    file.write_text("time,f_L1,f2 [Hz],air\n0,4.1,7.3,3\n60,,7.4,4\n", encoding="utf-8")
    record = load_modal_record(file, mast)
    assert record.frequency.tolist() == [4.1, 7.3, 7.4]
    assert record.hint == ("L1", "2", "2")
    assert record.contexts["air"].tolist() == [3.0, 3.0, 4.0]
    assert record.left_out == ()


@pytest.mark.parametrize(
    ("header", "told"),
    [
        ("time,f [rad/s]", "the unit of 'f' is 'rad/s'"),
        ("time,f1 [rad/s]", "the unit of 'f1' is 'rad/s'"),
        ("time,L1 [rad/s]", "the unit of 'L1' is 'rad/s'"),
        ("time,force", "there is no column 'f'"),
    ],
)
def test_other_units_and_other_columns_are_refused(
    tmp_path: Path, mast: Model, header: str, told: str
) -> None:
    file = tmp_path / "modes.csv"
    file.write_text(f"{header}\n0,25.1\n60,25.2\n", encoding="utf-8")
    with pytest.raises(InputError) as refused:
        load_modal_record(file, mast)
    assert told in str(refused.value)


def test_the_unit_that_is_right_may_stand_in_the_name(tmp_path: Path, mast: Model) -> None:
    file = tmp_path / "modes.csv"
    file.write_text("time,f [Hz],duration [s],n1_x\n0,4.1,60,1.0\n", encoding="utf-8")
    record = load_modal_record(file, mast)
    assert (record.frequency.tolist(), record.duration.tolist()) == ([4.1], [60.0])


@pytest.mark.parametrize("name", ["a.csv", "a.npz", "a.mat", "a.json", "a.nc", "a.uff"])
@pytest.mark.parametrize("content", [b"", b"words and no table\n", b"PK\x03\x04", b'{"Fn": [1'])
def test_files_of_nothing(tmp_path: Path, mast: Model, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError):
        load_modal_record(tmp_path / name, mast)
