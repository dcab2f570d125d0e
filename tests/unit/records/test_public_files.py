"""Loggers' files that others published, read as their description says: skipped where absent."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model
from rga.records import RecordMapping, load_record
from rga.records.mapping import TimeColumns
from rga.records.read import read_table
from rga.records.table import Table
from rga.records.times import read_clock

FOLDER = Path(__file__).parents[4] / "shared" / "imports" / "loggers"


def table(name: str, **stated: Any) -> Table:
    if not (FOLDER / name).exists():
        pytest.skip("loggers' files of others are not part of this project")
    return read_table(FOLDER / name, RecordMapping(**stated))


def times(found: Table) -> tuple[str | float, np.ndarray]:
    clock = read_clock(found, TimeColumns())
    return clock.start, clock.seconds


def missing(found: Table, column: str) -> int:
    return int(np.isnan(found.numbers(column)).sum())


def test_toa5_of_days_has_two_spellings_of_one_unit_and_columns_of_times() -> None:
    found = table("toa5_daily.dat")
    assert found.frame.shape == (2, 9)
    assert times(found)[0] == "2021-06-19 00:00:00"
    assert times(found)[1].tolist() == [0, 86400]
    assert found.numbers("BattV_Min").tolist() == [12.99, 12.96]
    assert found.numbers("PTemp_C_Max").tolist() == [39.16, 40.91]
    assert (found.units["PTemp"], found.units["PTemp_C_Max"]) == ("oC", "Deg C")
    assert found.bookkeeping == ("RECORD",)
    assert "BattV_TMn, PTemp_C_TMn, PTemp_C_TMx hold times" in " ".join(found.notes)
    assert "the day before" in " ".join(found.notes)
    with pytest.raises(InputError, match="2021-06-18 16:08:30"):
        found.numbers("BattV_TMn")


def test_toa5_at_200_hz_has_stamps_with_one_to_three_decimals() -> None:
    found = table("toa5_200Hz_nan.dat")
    assert found.frame.shape == (79, 18)
    start, seconds = times(found)
    assert start == "2026-02-19 09:46:17.005"
    assert np.median(np.diff(seconds)) == pytest.approx(0.005)
    assert seconds[-1] == pytest.approx(0.395)
    assert found.numbers("RECORD").tolist() == list(range(5333, 5412))
    assert [missing(found, f"temp_Avg({k})") for k in (1, 2, 3)] == [79, 79, 79]
    assert missing(found, "temp(1)") == 11
    assert found.numbers("temp(1)")[0] == -0.4282773
    assert found.numbers("temp(2)")[0] == 0.428
    assert found.numbers("text_val")[0] == 64291
    assert found.warnings == ()


def test_toa5_with_a_double_column_is_refused_with_the_column_and_the_line() -> None:
    with pytest.raises(InputError, match=r"'AirT_C\(42\)'.*Deg C and in %.*line 2"):
        table("toa5_bad_duplicate_column.dat")


def test_catman_binary_has_overflows_and_units_of_its_own() -> None:
    found = table("catman_2byte.bin")
    assert found.format == "catman binary"
    assert found.frame.shape == (100, 11 - 1)
    expected = [0.65017971, 0.66336057, 0.66786538]
    np.testing.assert_allclose(found.numbers("poti5k")[:3], expected, atol=5e-9)
    for name, first, unit in (
        ("U10M 500kN", -1.7351624, "Ohm"),
        ("MX840A_CH 5", 0.047701735, "V"),
        ("Baumer encoder 2500", 222.76801, "mm"),
    ):
        assert found.numbers(name)[0] == pytest.approx(first, rel=1e-7)
        assert found.units[name] == unit
    assert missing(found, "Poti5K TABLE 5-wire plus minus") == 100
    assert missing(found, "Thermocouple Type K") == 100
    assert found.units["Thermocouple Type K"] == "N"
    start, seconds = times(found)
    assert start == "2022-04-12T13:32:09+02:00"
    np.testing.assert_allclose(seconds[:2], [0, 0.0033346], atol=1e-6)
    hardware = "MX840A hardware time default sample rate"
    assert found.bookkeeping == (hardware,)
    assert found.numbers(hardware)[0] == pytest.approx(1649763129.69, abs=0.01)


def test_catman_without_its_test_file_has_no_zone(tmp_path: Path) -> None:
    table("catman_2byte.bin")
    data = (FOLDER / "catman_2byte.bin").read_bytes()
    (tmp_path / "alone.bin").write_bytes(data)
    found = read_table(tmp_path / "alone.bin")
    assert times(found)[0] == "2022-04-12T13:32:09"
    assert "no time zone" in " ".join(found.notes)
    for cut in (40, 5000, 30000, 34000):
        (tmp_path / "cut.bin").write_bytes(data[:cut])
        with pytest.raises(InputError, match="catman file ends"):
            read_table(tmp_path / "cut.bin")


def test_a_remark_above_and_time_in_the_ninth_column() -> None:
    found = table("quantumx_mx840_tab.csv")
    assert found.frame.shape == (712, 15)
    start, seconds = times(found)
    assert start == 0
    assert (np.diff(seconds) > 0).all()
    assert seconds[-1] == pytest.approx(146.39)
    force = found.numbers("Kraft [kN]")
    assert force[:2].tolist() == [0.164994, 0.160204]
    assert force.max() == 23.3718
    assert force[-1] == 0
    assert found.names["Kraft [kN]"] == "Kraft"
    assert found.units["MX840A_0_CH 5 [°C]"] == "°C"


def test_a_channel_that_never_moves_is_warned_of(two_bars: dict[str, Any]) -> None:
    table("quantumx_mx840_tab.csv")
    del two_bars["sensors"]["S1"]
    unused = dict.fromkeys(("Maschine", "Clip-Gauge", "Drehmoment", "Kraft"), "spare")
    unused |= {f"MX840A_0_CH {k}": "spare" for k in (5, 7, 8)}
    unused |= {f"Kanal {k}": "spare" for k in range(10, 16)}
    still = RecordMapping(channels={"D1": {"column": "MX840A_0_CH 6"}}, unused=unused)
    model = Model.model_validate(two_bars)
    record = load_record(FOLDER / "quantumx_mx840_tab.csv", model, still)
    assert record.warnings == ["D1 reads 0 in all 712 rows: it never moves"]


@pytest.mark.parametrize(
    ("name", "rows", "first", "day"),
    [
        ("mts_decimal_comma_cp1252.dat", 572, [41883, 34.306641, -1, -1.0232348], "2014-09-01"),
        (
            "mts_decimal_comma_broken_utf8.csv",
            931,
            [41842, 79.004883, -1.2784081, -1.2332071],
            "2014-07-22",
        ),
    ],
)
def test_mts_has_two_blocks_and_reads_the_first(
    name: str, rows: int, first: list[float], day: str
) -> None:
    found = table(name)
    columns = ["Datum", "Laufzeit", "Ch 1 Kraft Sollwert", "Ch 1 Kraft", "Ch 1 Weg"]
    assert found.frame.columns == [*columns, "1944 B", "1281068", "2157"]
    assert found.frame.height == rows
    assert [found.numbers(column)[0] for column in columns[:4]] == first
    assert [found.units[column] for column in columns] == ["d", "s", "kN", "kN", "mm"]
    notes = " ".join(found.notes)
    assert "block 2 has 5 columns and 2 rows" in notes
    assert day in notes
    assert times(found)[0] == first[1]
    second = table(name, block=2)
    assert second.frame.shape == (2, 5)
    with pytest.raises(InputError, match="the file has 2"):
        table(name, block=3)


def test_mts_in_cp1252_loses_no_letter_and_no_digit() -> None:
    found = table("mts_decimal_comma_cp1252.dat")
    last = [found.numbers(column)[-1] for column in ("Laufzeit", "Ch 1 Kraft")]
    assert last == [319.80664, 0.7769894]
    assert "read as cp1252: 'Prüfer" in found.notes[0]
    second = table("mts_decimal_comma_cp1252.dat", block=2)
    assert second.numbers("Ch 1 Kraft").tolist() == [0.80352277, -147.20456]
    assert second.numbers("Ch 1 W2TK Mittel")[1] == 1.4942721e-05


def test_characters_that_were_lost_before_are_told() -> None:
    found = table("mts_decimal_comma_broken_utf8.csv")
    assert found.warnings == ("characters are damaged in lines 5, 10: they are left as they are",)


def test_a_title_names_and_a_row_of_units_in_brackets() -> None:
    found = table("semicolon_decimal_comma_units_row.txt")
    assert found.frame.shape == (21, 3)
    assert dict(found.units) == {"t": "s", "x": "m", "y": "m"}
    start, seconds = times(found)
    assert (start, seconds[-1]) == (0, 0.8)
    assert found.numbers("x")[[0, 1, -1]].tolist() == [0.079, 0.165, 1.71]
    assert found.numbers("y")[[0, 1, -1]].tolist() == [-0.346, -0.21, -0.536]


def test_labview_counts_time_where_there_is_no_column_of_it() -> None:
    found = table("labview_short_decimal_comma.lvm")
    assert dict(found.units) == {"Excitation (Trigger)": "Newtons", "Response (Trigger)": "m/s^2"}
    assert found.frame.height == 10
    assert found.numbers("Excitation (Trigger)")[:2].tolist() == [0.914018, 0.537321]
    assert found.numbers("Response (Trigger)")[:2].tolist() == [1.204792, 1.208403]
    start, seconds = times(found)
    assert start == "2013-02-19T09:51:40.727189"
    np.testing.assert_allclose(np.diff(seconds), 3.90625e-5, rtol=1e-9)


def test_labview_channels_that_never_wrote_are_missing_and_not_zero() -> None:
    found = table("labview_empty_fields.lvm")
    start, seconds = times(found)
    assert start == "2016-08-11T15:37:48.375000"
    assert seconds.tolist() == [0, 0.001, 0.002, 0.003, 0.004, 0.005, 0.006]
    assert found.numbers("Dev0/Ai0")[:2].tolist() == [-0.011923, -0.009206]
    assert found.numbers("Dev0/Ai2")[0] == 7.254639
    for name in ("Untitled", "Untitled 1", "Untitled 2", "Untitled 3"):
        assert missing(found, name) == 7
    assert "the file states no units" in found.notes
    assert found.warnings == ("the head says 100 samples for each channel, 7 are there",)


def test_tdms_has_a_waveform_with_start_and_step() -> None:
    found = table("labview_timestamps.tdms")
    values = found.numbers("Untitled")
    expected = np.sin(2 * np.pi * np.arange(128) / 128)
    np.testing.assert_allclose(values, expected, atol=1e-9)
    start, seconds = times(found)
    assert start == "2024-01-24T01:48:43.068614+00:00"
    assert seconds[1] == 0.001


def test_line_protocol_has_a_channel_for_each_field_of_each_sensor() -> None:
    found = table("influx_air_sensors_first_24_lines.lp")
    assert found.frame.shape == (3, 1 + 8 * 3)
    start, seconds = times(found)
    assert start == "2021-06-11T09:32:25+00:00"
    assert seconds.tolist() == [0, 10, 20]
    expected = [71.23910178696566, 71.229547931762, 71.18947497603062]
    assert found.numbers("TLM0100 temperature").tolist() == expected
    assert "no units are stated" in found.notes


def test_sensorthings_have_the_time_of_the_phenomenon() -> None:
    found = table("sensorthings_data_array.json")
    start, seconds = times(found)
    assert start == "2005-08-05T12:21:13+00:00"
    assert seconds.tolist() == [0, 55, 101]
    assert found.numbers("Datastreams(1)").tolist() == [20, 30, 0]


@pytest.mark.parametrize("name", ["senml_rfc8428_ex3.json", "senml_rfc8428_ex3_resolved.json"])
def test_senml_is_resolved_as_its_standard_says(name: str) -> None:
    found = table(name)
    voltage, current = (f"urn:dev:ow:10e2073a0108006:{what}" for what in ("voltage", "current"))
    assert dict(found.units) == {voltage: "V", current: "A"}
    assert found.names[voltage] == "voltage"
    np.testing.assert_allclose(found.numbers(current), [1.2, 1.3, 1.4, 1.5, 1.6, 1.7])
    assert found.numbers(voltage)[-1] == 120.1
    start, seconds = times(found)
    assert start == "2010-06-08T18:01:11.001000+00:00"
    assert seconds.tolist() == [0, 1, 2, 3, 4, 5]
