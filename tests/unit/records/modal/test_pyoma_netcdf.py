"""NetCDF-4 as long monitoring with pyOMA writes it, made with h5py."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model
from rga.records.modal.read import load_modal_record
from unit.records.modal.conftest import POINTS

pytest.importorskip("pyfive", reason="pyfive reads NetCDF-4")
h5py = pytest.importorskip("h5py", reason="h5py writes the files of these tests")
RNG = np.random.default_rng(5)
SHAPES = RNG.standard_normal((2, 3, 4)) * np.exp(1j * RNG.uniform(0, 6, (2, 3, 1)))
VARIABLES: dict[str, Any] = {
    "time": np.array([0, 10]),
    "channels": np.array([name.encode() for name in POINTS], dtype=object),
    "modes": np.arange(3),
    "length": np.array([6000.0, 6000.0]),
    "sample_rate": np.array([10.0, 10.0]),
    "frequencies": np.array([[4.1, 7.3, 9.0], [np.nan, 7.4, 9.1]]),
    "std_frequencies": np.full((2, 3), 0.05),
    "damping": np.full((2, 3), 0.8),
    "modeshapes": SHAPES,
}
UNIT = "minutes since 2018-02-27 19:00:00"


def written(folder: Path, *, unit: str = UNIT, frequencies_in: str = "", **other: Any) -> Path:
    file = folder / "modal_accel.nc"
    with h5py.File(file, "w") as content:
        for name, values in (VARIABLES | other).items():
            if values is not None:
                words = values.dtype == object
                content.create_dataset(
                    name, data=values, dtype=h5py.string_dtype() if words else None
                )
        content["time"].attrs["units"] = unit
        content["time"].attrs["calendar"] = "proleptic_gregorian"
        if frequencies_in:
            content["frequencies"].attrs["units"] = frequencies_in
    return file


def test_windows_modes_and_channels(tmp_path: Path, mast: Model) -> None:
    record = load_modal_record(written(tmp_path), mast)
    assert record.frequency.tolist() == [4.1, 7.3, 9.0, 7.4, 9.1]
    assert record.start == "2018-02-27T19:05:00+00:00"  # the middle of ten minutes
    assert record.time.tolist() == [0.0, 0.0, 0.0, 600.0, 600.0]
    assert record.duration.tolist() == [600.0] * 5
    assert record.damping.tolist() == pytest.approx([0.008] * 5)
    assert record.frequency_sd.tolist() == [0.05] * 5
    assert record.points == POINTS
    assert record.realness.tolist() == pytest.approx([1.0] * 5)
    flat = SHAPES.reshape(6, 4)[[0, 1, 2, 4, 5]]
    mac = np.abs((flat.conj() * record.shapes).sum(1)) ** 2
    mac /= (np.abs(flat) ** 2).sum(1) * (record.shapes**2).sum(1)
    np.testing.assert_allclose(mac, 1.0)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"frequencies": None}, "no variable 'frequencies'"),
        ({"frequencies": np.full((2, 3), np.nan)}, "no mode was found"),
        ({"frequencies": np.ones((3, 3))}, "frequencies has the dimensions 3 x 3"),
        ({"frequencies": -np.ones((2, 3))}, "-1 Hz is no natural frequency"),
        ({"damping": np.ones((2, 2))}, "damping has the dimensions 2 x 2"),
        ({"modeshapes": SHAPES[:, :, :3]}, "modeshapes has the dimensions 2 x 3 x 3"),
        ({"channels": None}, "modeshapes has the dimensions 2 x 3 x 4"),
        ({"unit": "fortnights since 2018-02-27"}, "the unit of the time is 'fortnights"),
        ({"frequencies_in": "rad/s"}, "frequencies are in 'rad/s'"),
    ],
)
def test_what_cannot_be_meant(
    tmp_path: Path, mast: Model, change: dict[str, Any], told: str
) -> None:
    with pytest.raises(InputError) as refused:
        load_modal_record(written(tmp_path, **change), mast)
    assert told in str(refused.value)


def test_damaged_and_classic_files(tmp_path: Path, mast: Model) -> None:
    file = written(tmp_path)
    whole = file.read_bytes()
    for content in (whole[: len(whole) // 2], whole[:60], b"CDF\x01" + bytes(40)):
        file.write_bytes(content)
        with pytest.raises(InputError):
            load_modal_record(file, mast)
