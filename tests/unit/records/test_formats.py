"""Formats of which no public file is at hand, made up after what is known of them."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import savemat

from hostile.logger_files import catman_binary
from rga.errors import InputError
from rga.records import RecordMapping
from rga.records.mapping import TimeColumns
from rga.records.read import read_table
from rga.records.table import Table
from rga.records.times import read_clock


def table(path: Path, content: str | bytes, encoding: str = "utf-8", **stated: Any) -> Table:
    path.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
    return read_table(path, RecordMapping(**stated))


def begin(found: Table) -> tuple[str | float, list[float]]:
    clock = read_clock(found, TimeColumns())
    return clock.start, clock.seconds.tolist()


CATMAN = (
    "catmanEasy\nKanäle: 3\nT0 = 01.02.2024 10:00:00\n\n"
    "Zeit  1 - Standardmessrate [s]\tMS1 [µm/m] CH=1\tMS2 [µm/m] CH=2"
    "\tZeit  2 - Standardmessrate [s]\tT1 [°C] CH=3\t\n"
    "0,000\t1,5\t-1000000\t0,0001\t20,1\t\n"
    "0,010\t1,6\t2,5\t0,0101\t20,2\t\n"
    "0,020\t1,7\t2,6\t0,0201\t20,3\t\n"
)


def test_catman_text_has_units_overflows_and_a_second_time(tmp_path: Path) -> None:
    found = table(tmp_path / "r.asc", CATMAN, "cp1252")
    assert found.format == "catman text"
    assert begin(found) == ("2024-02-01T10:00:00", [0, 0.01, 0.02])
    assert found.names["MS1 [µm/m] CH=1"] == "MS1"
    assert found.units["MS1 [µm/m] CH=1"] == "µm/m"
    np.testing.assert_array_equal(found.numbers("MS2 [µm/m] CH=2"), [np.nan, 2.5, 2.6])
    assert found.numbers("T1 [°C] CH=3").tolist() == [20.1, 20.2, 20.3]
    assert found.bookkeeping == ("Zeit  2 - Standardmessrate [s]",)


def test_catman_text_in_english_with_units_in_a_line(tmp_path: Path) -> None:
    content = (
        "T0 = 2/13/2024 10:00:00 AM\n\nTime  1 - default sample rate\tMS1\t\ns\tµm/m\t\n"
        "a\tb\t\n0.00\t1.5\n0.01\t1.6\n"
    )
    found = table(tmp_path / "r.asc", content)
    assert begin(found)[0] == "2024-02-13T10:00:00"
    assert found.units["MS1"] == "µm/m"
    unsure = table(tmp_path / "r.asc", content.replace("2/13", "2/3"))
    assert begin(unsure)[0] == 0
    assert "read in two ways" in " ".join(unsure.notes)


def test_catman_rates_are_blocks(tmp_path: Path) -> None:
    content = (
        "Time  1 - default sample rate [s]\tA [µm/m]\tTime  2 - slow sample rate [s]\tT [°C]\n"
        "0,00\t1,0\t0,0\t20,1\n0,01\t1,1\t0,1\t20,2\n0,02\t1,2\t\t\n0,03\t1,3\t\t\n"
    )
    fast = table(tmp_path / "r.asc", content)
    assert fast.numbers("A [µm/m]").tolist() == [1, 1.1, 1.2, 1.3]
    assert "T [°C]" not in fast.frame.columns
    assert "block 2 has 1 channels" in " ".join(fast.notes)
    slow = table(tmp_path / "r.asc", content, block=2)
    assert begin(slow)[1] == [0, 0.1]
    assert slow.numbers("T [°C]").tolist() == [20.1, 20.2]


@pytest.mark.parametrize("width", [2, 4, 8])
def test_catman_numbers_of_every_width(width: int, tmp_path: Path) -> None:
    time, slow = [0.0, 0.01, 0.02], [0.0, 1.0]
    data = catman_binary(
        [
            ("Time  1 - default sample rate", "s", 8, time),
            ("MS1", "µm/m", width, [1.0, -2.0, 3.0]),
            ("Time  2 - slow sample rate", "s", 8, slow),
            ("T", "°C", width, [20.0, 21.0]),
        ]
    )
    found = table(tmp_path / "r.bin", data)
    np.testing.assert_allclose(found.numbers("MS1"), [1, -2, 3], atol=1e-4)
    assert begin(found) == ("2024-02-01T12:00:00", time)
    assert found.units["MS1"] == "µm/m"
    assert begin(table(tmp_path / "r.bin", data, block=2))[1] == slow


@pytest.mark.parametrize("timed", [False, True])
def test_catman_without_a_time_counts_seconds_and_says_so(timed: bool, tmp_path: Path) -> None:
    time = [("Time  1 - default sample rate", "s", 8, [0.0, 0.5, 1.0])]
    data = catman_binary([*time * timed, ("MS1", "µm/m", 8, [1.0, 2.0, 3.0])])
    found = table(tmp_path / "r.bin", data)
    assert begin(found)[1] == ([0, 0.5, 1] if timed else [0, 1, 2])
    assert ("no channel is the time" in " ".join(found.warnings)) != timed


LVM = (
    "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\t{x}\n"
    "***End_of_Header***\t\n\n"
)
SEGMENT = (
    "Channels\t2\nSamples\t2\t2\nDate\t2024/02/01\t2024/02/01\nTime\t{time}\t{time}\n"
    "Y_Unit_Label\tmm\tV\nX0\t0\t0\nDelta_X\t0.5\t0.5\n***End_of_Header***\t\t\n"
)


def test_labview_segments_follow_each_other(tmp_path: Path) -> None:
    parts = [
        SEGMENT.format(time=f"10:00:0{k}") + f"X_Value\tA\tB\tComment\n\t{k}\t1\n\t{k}\t2\n\n"
        for k in (0, 1)
    ]
    found = table(tmp_path / "r.lvm", LVM.format(x="No") + "".join(parts))
    assert begin(found) == ("2024-02-01T10:00:00", [0, 0.5, 1, 1.5])
    assert found.numbers("A").tolist() == [0, 0, 1, 1]
    assert dict(found.units) == {"A": "mm", "B": "V"}


def test_labview_channels_with_an_x_of_their_own(tmp_path: Path) -> None:
    rows = "X_Value\tA\tX_Value\tB\tComment\n0.0\t1.5\t0.0\t2\n0.25\t3\t0.25\t4\n"
    segment = SEGMENT.format(time="10:00:00,5")  # with a comma, whatever the sign of the numbers
    for cells in (
        "2\t2",
        "mm\tV",
        "2024/02/01\t2024/02/01",
        "0.5\t0.5",
        "0\t0",
        "10:00:00,5\t10:00:00,5",
    ):
        segment = segment.replace(f"\t{cells}\n", "\t{}\t\t{}\n".format(*cells.split("\t")))
    head = LVM.format(x="Multi").replace("Decimal_Separator\t.\n", "")
    found = table(tmp_path / "r.lvm", head + segment + rows)
    assert begin(found) == ("2024-02-01T10:00:00.500000", [0, 0.25])
    assert found.numbers("B").tolist() == [2, 4]
    assert dict(found.units) == {"A": "mm", "B": "V"}
    assert found.warnings == ()


def test_matlab_variables_are_channels(tmp_path: Path) -> None:
    time = np.arange(5) / 10
    values = {"t": time, "S1": time * 2, "acc": np.ones((5, 2)), "short": np.arange(3), "name": "x"}
    savemat(tmp_path / "r.mat", values)
    found = read_table(tmp_path / "r.mat")
    assert found.frame.columns == ["t", "S1", "acc 1", "acc 2"]
    assert begin(found) == (0, pytest.approx(time.tolist()))
    assert "block 2 has short of 3 rows" in " ".join(found.notes)
    savemat(tmp_path / "r.mat", {"data": {"S1": time, "fs": 50.0}})
    nested = read_table(tmp_path / "r.mat")
    assert nested.frame.columns == ["data.S1"]
    assert begin(nested)[1][1] == 0.02
    days = 739283 + np.arange(3) / 24
    savemat(tmp_path / "r.mat", {"time": days, "S1": np.arange(3)})
    assert begin(read_table(tmp_path / "r.mat")) == ("2024-02-01T00:00:00", [0, 3600, 7200])


def test_line_protocol_with_escapes_types_and_precisions(tmp_path: Path) -> None:
    content = (
        "# a comment\n"
        'bridge,node=a\\ b S1=1.5,n=3i,ok=t,text="a, b=c" 1706745600000\n'
        "bridge,node=a\\ b S1=2.5,n=4i 1706745601000\n"
        "wind,node=c v=9 1706745601000\n"
    )
    found = table(tmp_path / "r.lp", content)
    assert found.numbers("bridge a b S1").tolist() == [1.5, 2.5]
    assert found.numbers("bridge a b n").tolist() == [3, 4]
    np.testing.assert_array_equal(found.numbers("wind c v"), [np.nan, 9])
    assert found.names["wind c v"] == "v"
    assert found.names["bridge a b S1"] == "S1"
    assert begin(found) == ("2024-02-01T00:00:00+00:00", [0, 1])
    assert "times are taken as ms" in " ".join(found.notes)
    shared = table(tmp_path / "r.lp", "a,n=1 S1=1,T=9 1706745600\na,n=2 S1=2 1706745600\n")
    assert shared.names == {"1 T": "T"}
    with pytest.raises(InputError, match=r"has no time.*line 2"):
        table(tmp_path / "r.lp", "a,n=1 S1=1 1706745600\na,n=1 S1=1\n")
    with pytest.raises(InputError, match="has two values"):
        table(tmp_path / "r.lp", "a,n=1 S1=1 1706745600\na,n=1 S1=2 1706745600\n")


def test_senml_bases_hold_on_and_sums_are_told(tmp_path: Path) -> None:
    pack = [
        {"bn": "dev/", "bt": 1706745600, "bu": "Cel", "bv": 20, "n": "t", "v": 0.5},
        {"n": "t", "t": 60, "v": 1.0},
        {"n": "e", "u": "J", "s": 5},
    ]
    found = table(tmp_path / "r.json", json.dumps(pack))
    assert found.numbers("dev/t").tolist() == [20.5, 21]
    assert found.names["dev/t"] == "t"
    assert begin(found)[1] == [0, 60]
    assert "sums (s) are left out" in found.notes
    for spoilt, said in (
        ({"bver": 11}, "version 11"),
        ({"x_": 1}, "must be understood"),
        ({"u": "K"}, "is in 'Cel' before"),
        ({"v": "high"}, "'high' is no number"),
        ({"t": float("inf")}, "'inf' is no number"),
        ({"t": 1e15}, "beyond the year 9999"),
    ):
        pack[1] = {"n": "t", "t": 60, "v": 1.0, **spoilt}
        with pytest.raises(InputError, match=said):
            table(tmp_path / "r.json", json.dumps(pack))


def test_sensorthings_entries_have_units_and_any_order(tmp_path: Path) -> None:
    stream = {"name": "air", "unitOfMeasurement": {"symbol": "°C"}}
    entries = [
        {"phenomenonTime": f"2024-02-01T0{k}:00:00Z/2024-02-01T0{k}:10:00Z", "result": result,
         "Datastream": stream}
        for k, result in ((2, 21.5), (1, "20.5"), (3, None))
    ]  # fmt: skip
    found = table(tmp_path / "r.json", json.dumps({"value": entries}))
    np.testing.assert_array_equal(found.numbers("air"), [20.5, 21.5, np.nan])
    assert begin(found) == ("2024-02-01T01:10:00+00:00", [0, 3600, 7200])
    assert found.units == {"air": "°C"}
    array = {"components": ["result"], "dataArray": [[1]]}
    with pytest.raises(InputError, match="no phenomenonTime"):
        table(tmp_path / "r.json", json.dumps({"value": [array]}))


def test_toa5_says_which_records_are_lost(tmp_path: Path) -> None:
    content = (
        '"TOA5","L","CR6","1","2","3","4","Fast"\n"TIMESTAMP","RECORD","S1(1)"\n'
        '"TS","RN","microstrain"\n"","","Smp"\n'
        '"2024-02-01 10:00:00",0,1.5\n"2024-02-01 10:00:00.2",1,"NAN"\n'
        '"2024-02-01 10:00:00.8",4,INF\n'
    )
    found = table(tmp_path / "r.dat", content)
    np.testing.assert_array_equal(found.numbers("S1(1)"), [1.5, np.nan, np.nan])
    np.testing.assert_allclose(begin(found)[1], [0, 0.2, 0.8])
    assert found.warnings == ("2 rows are missing by their record numbers",)
