"""Text as loggers write it: encodings, signs, remarks, units, and words for missing values."""

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

MESSY = (
    "Messung Brücke\nKunde;Müller\n\nDatum;Uhrzeit;D1;Temperatur\n;;µm;°C\n"
    "01.02.2024;10:00:00,000;-12,5;1.234,5\n"
    "01.02.2024;10:00:00,100;-12,6;Overrange\n"
    "01.02.2024;10:00:00,200;-9999;20,1\n"
)


@pytest.fixture
def one_sensor(two_bars: dict[str, Any]) -> Model:
    del two_bars["sensors"]["S1"]
    two_bars["context"]["temperature"]["range"] = [-20, 2000]
    return Model.model_validate(two_bars)


def table(folder: Path, content: str | bytes, encoding: str = "utf-8", **stated: Any) -> Table:
    path = folder / "r.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
    return read_table(path, RecordMapping(**stated))


@pytest.mark.parametrize("encoding", ["cp1252", "utf-8", "utf-8-sig", "utf-16", "utf-16-le"])
def test_a_messy_file_is_read_without_a_key(
    encoding: str, tmp_path: Path, one_sensor: Model
) -> None:
    path = tmp_path / "r.csv"
    path.write_bytes(MESSY.encode(encoding))
    mapping = RecordMapping(
        missing=["-9999"], channels={"temperature": {"column": "Temperatur"}}, zero=None
    )
    record = load_record(path, one_sensor, mapping)
    assert record.start == "2024-02-01T10:00:00"
    np.testing.assert_allclose(record.time, [0, 0.1, 0.2])
    np.testing.assert_allclose(record.readings[:, 0], [-0.0125, -0.0126, np.nan])
    np.testing.assert_allclose(record.contexts["temperature"], [1234.5, np.nan, 20.1])
    notes = " | ".join(record.notes)
    for said in (
        "parted by semicolons; the decimal sign is a comma; '.' parts thousands",
        "names of columns are in line 4",
        "units are in line 5",
        "'Datum' and 'Uhrzeit'",
        "time stamps have no zone",
        "D1 from µm to mm",
        "'Overrange' stands for a missing value: temperature (1 row)",
        "'-9999' stands for a missing value: D1 (1 row)",
    ):
        assert said in notes
    assert ("read as cp1252: 'Messung Brücke', line 1" in notes) == (encoding == "cp1252")


def test_keys_state_what_a_file_leaves_open(tmp_path: Path) -> None:
    lines = "1;2;3\n4;5;6\n7;8;9\nt;a\ns;mm\n0;1.234\n1;2.000\n"
    stated = {"header_line": 4, "units_line": 5, "decimal": ",", "thousands": "."}
    found = table(tmp_path, lines, delimiter=";", encoding="cp1252", **stated)
    assert found.frame.columns == ["t", "a"]
    assert found.numbers("a").tolist() == [1234, 2000]
    assert found.units["a"] == "mm"
    assert found.where(0, "a").endswith("line 6, column 'a'")
    skipped = table(tmp_path, "a\nremark\nremark\n1\n2\n", header_line=1, data_line=4)
    assert skipped.numbers("a").tolist() == [1, 2]
    with pytest.raises(InputError, match="header_line = 9"):
        table(tmp_path, "a\n1\n", header_line=9)


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (("1'234.5", "2.5"), [1234.5, 2.5]),
        (("1\u00a0234,5", "2,5"), [1234.5, 2.5]),
        (("1 234,5", "2,5"), [1234.5, 2.5]),
        (("1.234.567", "2.345.678"), [1234567, 2345678]),
        (("7,90E-2", "-3,46E-1"), [0.079, -0.346]),
        (("1.5D+03", ".5"), [1500, 0.5]),
    ],
)
def test_numbers_in_the_ways_of_countries(
    cells: tuple[str, str], expected: list[float], tmp_path: Path
) -> None:
    found = table(tmp_path, f"time;D1\n0;{cells[0]}\n1;{cells[1]}\n")
    np.testing.assert_allclose(found.numbers("D1"), expected)


def test_thousands_and_decimals_in_quotes(tmp_path: Path) -> None:
    found = table(tmp_path, 'time,D1\n0,"1,234.5"\n1,"12,345.6"\n')
    assert found.numbers("D1").tolist() == [1234.5, 12345.6]
    unsure = table(tmp_path, "time;D1\n0;1,234\n1;12,345\n")
    assert unsure.numbers("D1").tolist() == [1.234, 12.345]
    assert "state decimal" in unsure.warnings[0]
    assert not table(tmp_path, "time;D1\n0;0,234\n1;12,345\n").warnings


@pytest.mark.parametrize(
    "word", ["NAN", "NaN", "Overrange", "OverRange", "-", "", "#N/A", "INF", "-INF"]
)
def test_words_for_a_missing_value(word: str, tmp_path: Path) -> None:
    found = table(tmp_path, f"time,D1\n0,1\n1,{word}\n2,3\n")
    np.testing.assert_array_equal(found.numbers("D1"), [1, np.nan, 3])


@pytest.mark.parametrize("stated", [["-999"], [-999], ["-999,0"], ["weg"]])
def test_what_stands_for_a_missing_value_is_stated(stated: list[Any], tmp_path: Path) -> None:
    cell = "weg" if stated == ["weg"] else "-999,00"
    found = table(tmp_path, f"time;D1\n0;1,5\n1;{cell}\n")
    missing = tuple(RecordMapping(missing=stated).missing)
    np.testing.assert_array_equal(found.numbers("D1", missing), [1.5, np.nan])


def test_codes_of_one_channel_are_numbers_in_another(
    tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    path = tmp_path / "r.csv"
    path.write_text("time,D1,S1\n0,1,-999\n1,-999,2\n2,1,3\n", encoding="utf-8")
    mapping = RecordMapping(channels={"D1": {"missing": ["-999"]}})
    record = load_record(path, Model.model_validate(two_bars), mapping)
    np.testing.assert_array_equal(record.readings[:, 0], [1, np.nan, 1])
    assert record.readings[0, 1] == -999


def test_trailing_signs_comments_and_blanks_between(tmp_path: Path) -> None:
    for content in (
        "time;D1;S1;\n0;1;2;\n1;2;3;\n",
        "time;D1;S1\n0;1;2;\n1;2;3;\n",
        "# a remark\n# time D1 S1\n  0   1   2\n  1   2 3\n\n",
        "time\tD1\tS1\r0\t1\t2\r1\t2\t3\r",
    ):
        found = table(tmp_path, content)
        assert found.frame.columns == ["time", "D1", "S1"]
        assert found.numbers("S1").tolist() == [2, 3]


def test_columns_without_names_are_counted(tmp_path: Path, one_sensor: Model) -> None:
    found = table(tmp_path, "0,1\n1,2\n2,3\n")
    assert found.frame.columns == ["column 1", "column 2"]
    mapping = RecordMapping(
        time=TimeColumns(columns=["column 1"]), channels={"D1": {"column": "column 2"}}
    )
    record = load_record(tmp_path / "r.csv", one_sensor, mapping)
    assert record.readings[:, 0].tolist() == [1, 2, 3]


def test_a_first_column_without_a_name_may_count_the_rows(
    tmp_path: Path, one_sensor: Model
) -> None:
    assert table(tmp_path, ",time,D1\n0,5,1\n1,6,2\n").bookkeeping == ("row number",)
    assert len(load_record(tmp_path / "r.csv", one_sensor)) == 2
    with pytest.raises(InputError, match="column 1 has no name"):
        table(tmp_path, ",time,D1\n7,5,1\n1,6,2\n")


def test_two_tables_in_one_file_are_refused(tmp_path: Path) -> None:
    rows = "".join(f"{k};{k}\n" for k in range(9))
    with pytest.raises(InputError, match="lines above the names in line 11 look like rows"):
        table(tmp_path, f"a;b\n{rows}c;d;e\n1;2;3\n2;3;4\n")


def test_all_unknown_columns_are_listed_at_once(tmp_path: Path, one_sensor: Model) -> None:
    names = [f"X{k}" for k in range(12)]
    path = tmp_path / "r.csv"
    path.write_text(f"time,D1,{','.join(names)}\n0,1{',2' * 12}\n", encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        load_record(path, one_sensor)
    assert all(repr(name) in str(refusal.value) for name in names)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "empty"),
        (b"PK\x03\x04" + bytes(60), "workbook"),
        (b"\x89HDF\r\n\x1a\n" + bytes(60), "HDF5"),
        (bytes(range(256)) * 8, "no table of text"),
        (b"time,D1\n0,1\n1\n", "line 3"),
        (b'{"a": [1, ', "no JSON"),
        (b'{"a": 1}', "neither SenML nor SensorThings"),
        (b"TDSm" + bytes(40), "TDMS file cannot be read|no channel"),
        (b"MATLAB 5.0 MAT-file" + bytes(200), "MATLAB file is damaged|no vector"),
        (b"MATLAB 7.3 MAT-file" + bytes(200), "'-v7'"),
        (b"LabVIEW Measurement\nSeparator\tTab\n", "End_of_Header"),
        (b"MTS793|MPT|DEU|1|2|,|.|:|49|1|1|A\n\n", "no table of names"),
        (b'"TOA5","a"\n"TIMESTAMP"\n', "lines of its head"),
        (b"time,D1\n0,1\n1,\x012\n", "line 3"),
    ],
)
def test_hostile_files_have_one_clear_error(content: bytes, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        table(tmp_path, content)


def test_a_long_file_is_read_at_once(tmp_path: Path) -> None:
    rows = "\n".join(f"{k},0;{k},5;-{k},25" for k in range(200_000))
    found = table(tmp_path, f"time;D1;S1\n{rows}\n")
    assert found.numbers("S1")[-1] == -199_999.25
    assert read_clock(found, TimeColumns()).seconds[-1] == 199_999


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ('time;D1;S1\n0;"1";2\n1;"2\n";2\n2;3;2\n', 3),
        ('time;D1;S1\n0;1;2\n1;2;3" pipe\n2;3;2\n', 3),
        ('time;"D1\n[mm]";S1\n0;1;2\n1;2;2\n2;3;2\n', None),
    ],
)
def test_a_quote_that_does_not_end_in_its_line_is_named(
    content: str, line: int | None, tmp_path: Path
) -> None:
    said = f"line {line}" if line else "line [12]"
    with pytest.raises(InputError, match=f"a quote begins in the line.*{said}"):
        table(tmp_path, content)


def test_blank_lines_between_rows_are_passed_over(tmp_path: Path, one_sensor: Model) -> None:
    content = "time;D1\n0;1\n\n1;2\n\n  \n2;3\n3;x\n"
    found = table(tmp_path, content)
    assert read_clock(found, TimeColumns()).seconds.tolist() == [0, 1, 2, 3]
    assert "blank lines between rows are passed over: 3 (line 3, 5, 6)" in found.notes
    with pytest.raises(InputError, match=r"'x' is no number .*line 8"):
        load_record(tmp_path / "r.csv", one_sensor)
    with pytest.raises(InputError, match=r"the time is missing .*line 6"):
        read_clock(table(tmp_path, "time;D1\n0;1\n1;2\n\n2;3\n;\n3;4\n"), TimeColumns())
    alone = table(tmp_path, "D1\n1\n\n3\n")
    np.testing.assert_array_equal(alone.numbers("D1"), [1, np.nan, 3])
