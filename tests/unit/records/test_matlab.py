"""What is read from MATLAB files is what SciPy reads, and no file ends the process."""

import io
import struct
import zlib
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import loadmat, savemat
from scipy.sparse import csc_array

from rga.errors import InputError
from rga.records.formats.matlab_file import arrays_of
from rga.records.read import read_table

DRAW = np.random.default_rng(1)
VALUES: dict[str, Any] = {
    "S1": DRAW.standard_normal(50),
    "row": DRAW.standard_normal((1, 9)),
    "matrix": DRAW.standard_normal((6, 3)),
    "tensor": DRAW.standard_normal((2, 3, 4)),
    "empty": np.zeros((0, 3)),
    "scalar": 5.5,
    **{kind: np.arange(7, dtype=kind) for kind in ("i1", "u1", "i2", "u2", "i4", "u4", "f4")},
    **{kind: np.arange(7, dtype=kind) for kind in ("i8", "u8")},
    "switch": np.array([True, False]),
    "complex": np.array([1j, 2.0]),
}
#: what is left out
OTHERS: dict[str, Any] = {
    "word": "hello",
    "cell": np.array(["x", 1], dtype=object),
    "structs": np.zeros(2, dtype=[("a", "f8")]),
    "sparse": csc_array(np.eye(3)),
}


def saved(values: dict[str, Any], *, packed: bool = False, form: str = "5") -> bytes:
    file = io.BytesIO()
    savemat(file, values, do_compression=packed, format=form)
    return file.getvalue()


@pytest.mark.parametrize("packed", [False, True])
def test_arrays_are_those_that_scipy_reads(packed: bool) -> None:
    data = saved(VALUES | OTHERS, packed=packed)
    known = loadmat(io.BytesIO(data), squeeze_me=True)
    found = dict(arrays_of(data))
    assert list(found) == list(VALUES)
    for name, array in found.items():
        if array.size:
            np.testing.assert_array_equal(array, known[name], strict=name != "switch")


def test_version_4_and_structs() -> None:
    kept = ("S1", "row", "matrix", "scalar", "i2", "i4", "u1", "f4", "complex")
    old = {name: VALUES[name] for name in kept}
    data = saved(old | {"word": "hello"}, form="4")
    known = loadmat(io.BytesIO(data), squeeze_me=True)
    found = dict(arrays_of(data))
    assert list(found) == list(old)
    for name, array in found.items():
        np.testing.assert_array_equal(array, known[name])
    inner = {"a": np.arange(3.0), "deep": {"b": 2.0, "word": "x"}}
    within = dict(arrays_of(saved({"data": inner})))
    assert {name: array.tolist() for name, array in within.items()} == {
        "data.a": [0, 1, 2],
        "data.deep.b": 2,
    }


def test_bytes_in_the_other_order() -> None:
    numbers = struct.pack(">II3d", 9, 24, 1.0, 2.0, 3.0)
    head = struct.pack(">IIII", 6, 8, 6, 0) + struct.pack(">IIii", 5, 8, 3, 1)
    matrix = head + struct.pack(">HH", 2, 1) + b"S1\0\0" + numbers
    data = b"MATLAB 5.0".ljust(124) + b"\x01\x00MI" + struct.pack(">II", 14, len(matrix)) + matrix
    ((name, array),) = arrays_of(data)
    assert (name, array.tolist()) == ("S1", [1.0, 2.0, 3.0])
    old = struct.pack(">5i", 1000, 1, 2, 0, 2) + b"T\0" + struct.pack(">2d", 4.0, 5.0)
    ((name, array),) = arrays_of(old)
    assert (name, array.tolist()) == ("T", [4.0, 5.0])


@pytest.mark.parametrize("place", range(128, 220))
def test_any_changed_byte_is_told_or_changes_what_is_read(place: int, tmp_path: Path) -> None:
    data = bytearray(saved({"S1": np.arange(4.0), "t": np.arange(4.0)}))
    data[place] ^= 0xFF
    (tmp_path / "r.mat").write_bytes(data)
    with suppress(InputError):
        table = read_table(tmp_path / "r.mat")
        assert table.frame.height <= 4


def packed(*variables: bytes) -> bytes:
    """A file of one packed element."""
    content = zlib.compress(b"".join(one[128:] for one in variables), 9)
    head = b"MATLAB 5.0".ljust(124) + b"\x00\x01IM"
    return head + struct.pack("<II", 15, len(content)) + content


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (packed(saved({"S1": np.zeros(20_000_000)})), "unpacks to far more"),
        (packed(saved({"S1": np.zeros((60_000, 1000), "u1")})), "far more numbers than its size"),
        (packed(saved({f"a{k}": 1.0 for k in range(60_000)})), "more than 200,000 parts"),
        (saved({"S1": 1.0}, form="4") * 200_001, "twice"),
        (bytes(2_000_000), "a length in it is damaged"),
        (saved({"S1": [1.0, 2.0]}) + saved({"S1": [3.0, 4.0]})[128:], "'S1' stands twice"),
    ],
    ids=["bytes", "numbers", "parts", "variables", "zeros", "names"],
)
def test_what_no_measurement_is_is_refused(data: bytes, said: str, tmp_path: Path) -> None:
    (tmp_path / "r.mat").write_bytes(data)
    with pytest.raises(InputError, match=said):
        read_table(tmp_path / "r.mat")


def test_all_variables_of_a_packed_element_are_read() -> None:
    data = packed(saved({"S1": [1.0, 2.0]}), saved({"S2": [3.0, 4.0]}))
    assert {name: array.tolist() for name, array in arrays_of(data)} == {
        "S1": [1, 2],
        "S2": [3, 4],
    }


def test_rates_that_differ_are_no_rate(tmp_path: Path) -> None:
    values = {"S1": np.arange(3.0), "fs": 50.0}
    savemat(tmp_path / "r.mat", values | {"camera": {"fs": 50.0}})
    table = read_table(tmp_path / "r.mat")
    assert table.time is not None
    assert table.time.step == 0.02
    savemat(tmp_path / "r.mat", values | {"camera": {"fs": 25.0}})
    table = read_table(tmp_path / "r.mat")
    assert table.time is None
    assert "fs = 50 and camera.fs = 25 differ" in " ".join(table.notes)


def test_day_numbers_are_those_of_all_rows(tmp_path: Path) -> None:
    days = 739283 + np.array([0.0, np.nan, 1.0])
    savemat(tmp_path / "r.mat", {"time": days, "S1": np.arange(3.0)})
    assert "is taken as the time in seconds" in " ".join(read_table(tmp_path / "r.mat").notes)
