"""Parquet files and frames as strangers write them: read, or refused in a line."""

import random
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from rga.errors import InputError
from rga.records.formats import bounds
from rga.records.frames import table_of_frame
from rga.records.read import read_table

ROWS = 240


@pytest.fixture
def frame() -> pl.DataFrame:
    time = pl.Series("time", 1_700_000_000_000_000 + 60_000_000 * np.arange(ROWS))
    readings = {f"D{number}": np.sin(np.arange(ROWS) * number) for number in range(1, 6)}
    return pl.DataFrame({"time": time.cast(pl.Datetime("us")), **readings})


def test_bits_of_the_footer(
    frame: pl.DataFrame, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "record.parquet"
    frame.write_parquet(path)
    whole = path.read_bytes()
    footer = int.from_bytes(whole[-8:-4], "little") + 8
    draw, told = random.Random(0), list[str]()
    for _ in range(300):
        damaged = bytearray(whole)
        damaged[-draw.randrange(1, footer + 1)] ^= 1 << draw.randrange(8)
        path.write_bytes(damaged)
        try:
            read_table(path)
        except InputError as error:
            told.append(str(error))
    assert any("do not fit together" in one for one in told)
    assert not [one for one in told if "\n" in one]
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("unit", ["ms", "us"])
@pytest.mark.parametrize("time", [2**63 - 1, -(2**63) + 1])
def test_times_beyond_the_calendar(time: int, unit: str, frame: pl.DataFrame) -> None:
    times = pl.Series("time", [0, *[time] * (ROWS - 1)]).cast(pl.Datetime(unit))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="row 2 lies beyond the years 1 to 9999"):
        table_of_frame(frame.with_columns(times))


def test_the_first_and_the_last_day_of_the_calendar(frame: pl.DataFrame) -> None:
    days = pl.Series("time", ["0001-01-01", "9999-12-31"]).str.to_date()
    for kind in (pl.Date, pl.Datetime("ms"), pl.Datetime("us")):
        assert table_of_frame(pl.DataFrame([days.cast(kind)])).frame.height == 2
    for kind in (pl.Datetime("ns"), pl.Duration("us")):
        given = frame.with_columns(pl.col("time").cast(pl.Int64).cast(kind))
        assert table_of_frame(given).frame.height == ROWS


def test_categories_are_texts(frame: pl.DataFrame, tmp_path: Path) -> None:
    times = frame["time"].dt.to_string("%Y-%m-%d %H:%M:%S").cast(pl.Categorical)
    frame.with_columns(times).write_parquet(tmp_path / "record.parquet")
    assert read_table(tmp_path / "record.parquet").frame["time"].dtype == pl.String
    assert table_of_frame(frame.with_columns(times)).frame["time"].dtype == pl.String


def test_more_values_than_measurements_compress_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bounds, "MOST_VALUES", 100_000)
    draw = np.random.default_rng(1)
    for name, values in (("zeros", np.zeros(600_000)), ("noise", draw.normal(size=600_000))):
        pl.DataFrame({"D1": values}).write_parquet(tmp_path / f"{name}.parquet")
    assert read_table(tmp_path / "noise.parquet").frame.height == 600_000
    with pytest.raises(InputError, match="says that it has 6e"):
        read_table(tmp_path / "zeros.parquet")


def test_a_long_cell_is_not_shown_in_full() -> None:
    error = InputError("x" * 10**6, "here", "mend it")
    assert len(str(error)) < 1100
    assert str(error).endswith(" ... (here): mend it")
