"""Times as loggers write them: formats, zones, the hour that comes twice, numbers of days."""

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga.errors import InputError
from rga.records.mapping import TimeColumns
from rga.records.read import read_table
from rga.records.times import Clock, read_clock
from rga.records.times.clock import _by_format
from rga.records.times.written import moments_by, possible_formats, written_format


def clock(folder: Path, header: str, stamps: list[str], **stated: Any) -> Clock:
    rows = "".join(f"{stamp};{k}\n" for k, stamp in enumerate(stamps))
    (folder / "r.csv").write_text(f"{header};D1\n{rows}", encoding="utf-8")
    return read_clock(read_table(folder / "r.csv"), TimeColumns(**stated))


@pytest.mark.parametrize(
    ("header", "stamps", "start", "step"),
    [
        (
            "time",
            ["2024-01-01T00:00:00.4", "2024-01-01T00:00:00.41"],
            "2024-01-01T00:00:00.4",
            0.01,
        ),
        ("Datum;Zeit", ["1.2.2024;10:00:00", "1.2.2024;10:00:10"], "2024-02-01T10:00:00", 10),
        ("Timestamp", ["01/13/2024 1:00 PM", "01/13/2024 1:10 PM"], "2024-01-13T13:00:00", 600),
        ("Date", ["31/12/23 23:59:59", "01/01/24 00:00:00"], "2023-12-31T23:59:59", 1),
        ("Zeit", ["13.1.2024 10:00:00", "13.1.2024 10:00:00,5"], "2024-01-13T10:00:00", 0.5),
        ("Time", ["03-Feb-2024 10:00:00", "03-Feb-2024 10:00:01"], "2024-02-03T10:00:00", 1),
        ("t [ms]", ["0", "250"], 0.0, 0.25),
        ("Zeit [min]", ["1,5", "2,0"], 90.0, 30),
        (
            "Date Time, GMT+02:00",
            ["01/13/24 10:00", "01/13/24 10:10"],
            "2024-01-13T10:00:00+02:00",
            600,
        ),
    ],
)
def test_what_can_be_nothing_but_the_time_needs_no_key(
    header: str, stamps: list[str], start: str | float, step: float, tmp_path: Path
) -> None:
    found = clock(tmp_path, header, stamps)
    assert found.start == start
    np.testing.assert_allclose(found.seconds, [0, step])


def test_day_and_month_that_cannot_be_told_apart_are_asked_for(tmp_path: Path) -> None:
    stamps = ["03/04/2024 10:00", "03/04/2024 10:10"]
    with pytest.raises(InputError, match="cannot be told apart"):
        clock(tmp_path, "Timestamp", stamps)
    found = clock(tmp_path, "Timestamp", stamps, format="%d/%m/%Y %H:%M")
    assert found.start == "2024-04-03T10:00:00"
    months = [f"{month:02d}/01/2024 00:00" for month in range(1, 13)]
    assert written_format(months) is None
    hours = [f"01/{day:02d}/2024 {hour:02d}:00" for day in range(1, 12) for hour in range(24)]
    assert written_format(hours) == "%m/%d/%Y %H:%M"


@pytest.mark.parametrize(
    "stamps",
    [
        ["24/01/05 10:00", "24/01/05 10:10"],
        ["24-01-05 10:00", "24-01-05 10:10"],
        ["24.03.05 10:00:00", "24.03.05 10:00:01"],
        ["24/01/05", "24/01/06"],
        ["01/02/24 10:00", "31/01/24 10:00"],
        # A campaign on the fifth of each month is no two days.
        ["05/01/2024 10:00", "05/01/2024 10:10", "05/02/2024 10:00", "05/02/2024 10:10"],
    ],
)
def test_an_order_of_day_month_and_year_is_not_guessed(stamps: list[str], tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'cannot be told apart.*format = "%.*" or "%') as refusal:
        clock(tmp_path, "time", stamps)
    assert all(f'"{choice}"' in str(refusal.value) for choice in possible_formats(stamps))


@pytest.mark.parametrize(
    ("pattern", "step", "count"),
    [("%y/%m/%d %H:%M", 12, 4), ("%d/%m/%y %H:%M", 1, 30), ("%m/%d/%y %H:%M", 1, 30),
     ("%d.%m.%y %H:%M", 0.5, 60), ("%y.%m.%d %H:%M", 0.5, 60), ("%y-%m-%d %H:%M", 6, 40)],
)  # fmt: skip
def test_the_order_by_which_time_goes_on_at_midnight_is_read(
    pattern: str, step: float, count: int, tmp_path: Path
) -> None:
    start = datetime(2024, 1, 5)
    stamps = [(start + timedelta(hours=k * step)).strftime(pattern) for k in range(count)]
    found = clock(tmp_path, "time", stamps)
    assert found.start == "2024-01-05T00:00:00"
    np.testing.assert_allclose(np.diff(found.seconds), step * 3600)
    assert f"times are read as {pattern}" in found.notes


@pytest.mark.parametrize(
    "pattern", ["%d-%m-%Y %H:%M:%S.%f", "%d.%m.%y %I:%M:%S %p", "%Y/%m/%d %H:%M", "%d-%b-%Y"]
)
def test_many_stamps_at_once_are_as_each_alone(pattern: str) -> None:
    start = pl.datetime(2024, 1, 31, 11, 59, 58, 987_654)
    frame = pl.select(pl.datetime_range(start, pl.datetime(2024, 3, 1), "7h13m1s7us"))
    texts = [moment.strftime(pattern) for moment in frame.to_series()]
    assert moments_by(texts, pattern) == [_by_format(text, pattern) for text in texts]
    assert moments_by([*texts, "?"], pattern) is None


NIGHT = ["00:30", "01:00", "01:30", "02:00", "02:30", "02:00", "02:30", "03:00"]


def test_the_hour_that_comes_twice_may_be_refused(tmp_path: Path) -> None:
    night = ["2024-10-27 01:30:00", "2024-10-27 02:30:00", "2024-10-27 03:30:00"]
    with pytest.raises(InputError, match=r"02:30:00 exists twice in Europe/Berlin.*line 3"):
        clock(tmp_path, "time", night, zone="Europe/Berlin", repeated_hour="refused")
    for stamps, zone in ((night, "+01:00"), ([night[0], night[2]], "Europe/Berlin")):
        found = clock(tmp_path, "time", stamps, zone=zone, repeated_hour="refused")
        assert len(found.seconds) == len(stamps)


def test_the_hour_that_comes_twice_is_told_apart_by_the_rows(tmp_path: Path) -> None:
    stamps = [f"2023-10-29 {at}" for at in NIGHT]
    found = clock(tmp_path, "time", stamps, zone="Europe/Berlin")
    assert found.start == "2023-10-29T00:30:00+02:00"
    assert (np.diff(found.seconds) == 1800).all()
    assert "comes twice on 2023-10-29" in found.notes[0]
    with pytest.raises(InputError, match="state \\[time\\] zone"):
        clock(tmp_path, "time", stamps)


def test_an_hour_that_is_there_once_is_said(tmp_path: Path) -> None:
    stamps = [f"2023-10-29 {at}" for at in ("01:00", "02:00", "03:00")]
    found = clock(tmp_path, "time", stamps, zone="Europe/Berlin")
    assert found.seconds.tolist() == [0, 3600, 3 * 3600]
    assert "taken as summer time" in found.notes[0]
    hourly = [f"2023-10-29 {at}" for at in ("01:00", "02:00", "02:00", "03:00")]
    again = clock(tmp_path, "time", hourly, zone="Europe/Berlin")
    assert again.seconds.tolist() == [0, 3600, 7200, 10800]


@pytest.mark.parametrize(
    ("night", "begins", "steps", "said"),
    [
        (("02:00", "02:30", "03:00", "03:30"), "+01:00", [30, 30, 30], "standard time"),
        (("02:30", "03:00"), "+01:00", [30], "standard time"),
        (("00:30", "02:00", "02:30", "03:00", "03:30"), "+02:00", [150, 30, 30, 30], "standard"),
        (("01:00", "01:30", "02:00", "02:30"), "+02:00", [30, 30, 30], "summer time"),
        (("02:00", "02:30"), "+02:00", [30], "summer time"),
    ],
)
def test_an_hour_that_is_there_once_leaves_few_gaps(
    night: tuple[str, ...], begins: str, steps: list[int], said: str, tmp_path: Path
) -> None:
    found = clock(tmp_path, "time", [f"2024-10-27 {at}" for at in night], zone="Europe/Berlin")
    assert str(found.start).endswith(begins)
    assert (np.diff(found.seconds) / 60).tolist() == steps
    assert f"are taken as {said}" in found.notes[0]


def test_an_hour_that_does_not_exist_is_refused_with_its_line(tmp_path: Path) -> None:
    stamps = [f"2023-03-26 {at}" for at in ("01:30", "02:30", "03:30")]
    with pytest.raises(InputError, match=r"02:30:00 does not exist in Europe/Berlin.*line 3"):
        clock(tmp_path, "time", stamps, zone="Europe/Berlin")
    found = clock(tmp_path, "time", stamps, zone="+01:00")
    assert found.seconds.tolist() == [0, 3600, 7200]
    assert found.start == "2023-03-26T01:30:00+01:00"
    with pytest.raises(ValueError, match="no time zone 'Mars/Base'"):
        clock(tmp_path, "time", stamps, zone="Mars/Base")


@pytest.mark.parametrize(
    ("kind", "cells", "start", "step"),
    [
        ("excel", ["45323,5", "45323,75"], "2024-02-01T12:00:00", 21600),
        ("unix", ["1706745600", "1706745601.5"], "2024-02-01T00:00:00+00:00", 1.5),
        ("unix_ms", ["1706745600000", "1706745600250"], "2024-02-01T00:00:00+00:00", 0.25),
    ],
)
def test_times_that_are_numbers(
    kind: str, cells: list[str], start: str, step: float, tmp_path: Path
) -> None:
    found = clock(tmp_path, "Date", cells, columns=["Date"], format=kind)
    assert found.start == start
    np.testing.assert_allclose(found.seconds, [0, step], atol=1e-5)
    with pytest.raises(InputError, match="none of the years"):
        clock(tmp_path, "Date", ["1e20", "2e20"], columns=["Date"], format=kind)


def test_rows_are_counted_from_the_first_stamp(tmp_path: Path) -> None:
    found = clock(tmp_path, "time", ["2024-01-01T00:00"] * 3, sampling_rate_hz=200)
    assert found.seconds.tolist() == [0, 0.005, 0.01]
    assert found.start == "2024-01-01T00:00"


@pytest.mark.parametrize(
    ("cells", "choice"),
    [
        ([f"{45356.5 + k / 24:.6f}" for k in range(30)], "excel"),
        ([f"{45356.5 + k / 144:.4f}".replace(".", ",") for k in range(30)], "excel"),
        (["45356", "45357", "45358"], "excel"),
        ([f"{1709632800000 + k * 1000}" for k in range(30)], "unix_ms"),
        (["1709632800000000", "1709632800100000"], "unix_us"),
        (["1709632800000000000", "1709632800100000000"], "unix_ns"),
        (["202403051000", "202403051010"], "%Y%m%d%H%M"),
        (["2024030510", "2024030511"], "%Y%m%d%H"),
        (["20240305", "20240306"], "%Y%m%d"),
        (["5032024100000", "5032024100100"], "excel"),
    ],
)
def test_numbers_that_hardly_are_seconds_are_asked_for(
    cells: list[str], choice: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=f'hardly are seconds.*line 2.*"{choice}"'):
        clock(tmp_path, "time", cells)
    numbers = [float(cell.replace(",", ".")) for cell in cells]
    found = clock(tmp_path, "time", cells, format="seconds")
    np.testing.assert_allclose(found.seconds, np.array(numbers) - numbers[0])
    stated = clock(tmp_path, "time [ms]", cells, columns=["time [ms]"])
    np.testing.assert_allclose(stated.seconds, found.seconds / 1000, atol=1e-5)


@pytest.mark.parametrize(
    "cells",
    [
        ["0", "0.01"],
        ["0", "45356.5"],
        ["86399.5", "86400.5"],
        ["45356.50", "45356.51", "45356.52"],
        ["36000", "36060"],
        ["20240399", "20240400"],
        ["-5", "1e6"],
    ],
)
def test_seconds_from_the_beginning_of_a_record_stay_what_they_are(
    cells: list[str], tmp_path: Path
) -> None:
    found = clock(tmp_path, "time", cells)
    assert found.start == float(cells[0])
    np.testing.assert_allclose(found.seconds[1], float(cells[1]) - float(cells[0]))
    assert found.notes == ()


def test_seconds_since_1970_stay_seconds_and_are_said(tmp_path: Path) -> None:
    found = clock(tmp_path, "time", ["1709632800.5", "1709632801.5"])
    assert (found.start, found.seconds.tolist()) == (1709632800.5, [0, 1])
    assert 'format = "unix"' in found.notes[0]


def test_a_date_of_fourteen_digits_is_read(tmp_path: Path) -> None:
    found = clock(tmp_path, "time", ["20240305235959", "20240306000000", "20240306000100"])
    assert found.start == "2024-03-05T23:59:59"
    assert found.seconds.tolist() == [0, 1, 61]
    assert "times are read as %Y%m%d%H%M%S" in found.notes


def test_units_of_the_time_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text("time [s];D1\nms;mm\n0;1\n1;2\n", encoding="utf-8")
    with pytest.raises(InputError, match="says 's', the line of units says 'ms'"):
        read_clock(read_table(tmp_path / "r.csv"), TimeColumns(columns=["time [s]"]))


@pytest.mark.parametrize(
    ("header", "pattern"),
    [
        ("time", "%Y-%m-%dT{}:00:00"),
        ("time", "%d/%m/%y {}:00"),
        ("Date;Time", "%d.%m.%Y;{}:00:00"),
        ("Date;Time", "%d.%m.%Y;{}:00:00,0"),
    ],
)
def test_the_end_of_a_day_is_midnight(header: str, pattern: str, tmp_path: Path) -> None:
    hours = [datetime(2024, 12, 30) + timedelta(hours=k) for k in range(1, 50)]
    stamps = [
        (at - timedelta(days=1) if at.hour == 0 else at).strftime(
            pattern.format(f"{at.hour or 24:02d}")
        )
        for at in hours
    ]
    found = clock(tmp_path, header, stamps)
    assert (np.diff(found.seconds) == 3600).all()
    assert str(found.start).startswith("2024-12-30T01:00")
    assert any("24:00 is midnight at the end of the day" in note for note in found.notes)
    alone = clock(tmp_path, "time", ["2024-03-05 24:00:00", "2024-03-06 00:10:00"])
    assert (alone.start, alone.seconds.tolist()) == ("2024-03-06T00:00:00", [0, 600])
    with pytest.raises(InputError, match="cannot be read"):
        clock(tmp_path, "time", ["2024-03-05 23:00:00", "2024-03-05 24:10:00"])
