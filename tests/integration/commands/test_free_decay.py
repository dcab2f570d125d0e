"""`rga free-decay`: a logger's file in, a modal record out."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from conftest import Outcome

SHARED = Path(__file__).parents[3].parent / "shared"


@pytest.fixture
def logged(tmp_path: Path) -> Path:
    """Two accelerometers of a structure that swings at 2 Hz from 5 s on."""
    time = np.arange(0.0, 20.0, 0.02)
    after = np.maximum(time - 5.0, 0.0)
    swing = (time >= 5.0) * np.exp(-0.3 * after) * np.cos(4 * np.pi * after)
    noise = 0.01 * np.random.default_rng(3).standard_normal((2, len(time)))
    columns = {"time": time.round(6), "a": swing + noise[0], "b": -0.5 * swing + noise[1]}
    path = tmp_path / "logged.csv"
    pl.DataFrame(columns).write_csv(path)
    return path


def test_modes_are_printed_and_written_as_a_record(
    rga: Callable[..., Outcome], logged: Path, tmp_path: Path
) -> None:
    record = tmp_path / "modes.csv"
    done = rga(
        "free-decay", logged, "--highest", 5, "--from", 5.1, "--column", "a=A1",
        "--column", "b=B 1", "-o", record,
    )  # fmt: skip
    assert done.code == 0, done.err
    (line,) = [one for one in done.out.splitlines()[1:] if "noise" not in one]
    assert line.split()[0] == "2.000"
    assert "A1 1.0, B 1 \N{MINUS SIGN}0.50" in line
    written = pl.read_csv(record)
    assert written.columns == ["time", "duration", "f", "f_sd", "zeta", "A1", "B 1"]
    assert written["f"].to_list() == [pytest.approx(2.0, abs=0.01)]
    assert written["time"].to_list() == [pytest.approx(12.54, abs=0.02)]
    assert written["zeta"].to_list() == [pytest.approx(0.3 / (4 * np.pi), rel=0.1)]


def test_of_what_does_not_swing_nothing_is_written(
    rga: Callable[..., Outcome], logged: Path, tmp_path: Path
) -> None:
    record = tmp_path / "modes.csv"
    done = rga("free-decay", logged, "--highest", 5, "--until", 4.9, "-o", record)
    assert done.code == 0, done.err
    assert not record.exists()
    assert "not written" in done.out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--column", "c"], "there is no column 'c'"),
        (["--column", "a=A", "--column", "b=A"], "'A' is given twice"),
        (["--from", "40"], "no samples in the stretch"),
        (["--from", "5", "--until", "4"], "no samples in the stretch"),
        (["--until", "0.5"], "lasts"),
    ],
)
def test_what_cannot_be_read_is_told(
    options: list[str], words: str, rga: Callable[..., Outcome], logged: Path
) -> None:
    done = rga("free-decay", logged, "--highest", 5, *options)
    assert done.code == 2
    assert words in done.err
    assert done.err.startswith("error: ")
    assert len(done.err.splitlines()) == 1


def test_a_file_of_times_alone_is_told(rga: Callable[..., Outcome], logged: Path) -> None:
    pl.read_csv(logged).select("time").write_csv(logged)
    done = rga("free-decay", logged, "--highest", 5)
    assert done.code == 2
    assert "nothing but the time" in done.err


def test_a_gap_in_time_is_told(rga: Callable[..., Outcome], logged: Path) -> None:
    table = pl.read_csv(logged)
    pl.concat([table[:300], table[350:]]).write_csv(logged)
    done = rga("free-decay", logged, "--highest", 5)
    assert done.code == 2
    assert "s pass where" in done.err


@pytest.mark.skipif(not SHARED.exists(), reason="the measured records are not here")
def test_a_railway_bridge_after_its_train(rga: Callable[..., Any], tmp_path: Path) -> None:
    """Lateral and vertical mode of the free vibration behind a train at 40 km/h."""
    record = tmp_path / "modes.csv"
    raw = SHARED / "measured/rdso45m/record_40kmh.txt"
    done = rga("free-decay", raw, "--highest", 10, "--from", 30.8, "-o", record)
    assert done.code == 0, done.err
    lateral, vertical = pl.read_csv(record)["f"].to_list()
    assert lateral == pytest.approx(2.66, abs=0.07)
    assert vertical == pytest.approx(5.46, abs=0.07)
