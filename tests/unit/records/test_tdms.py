"""TDMS files: parts whose rows belong together, times, and what is damaged."""

import struct
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nptdms import ChannelObject, GroupObject, RootObject, TdmsFile, TdmsWriter

from rga.errors import InputError
from rga.records import RecordMapping
from rga.records.formats.tdms_parts import Values, parts_of, with_rows_together
from rga.records.mapping import TimeColumns
from rga.records.read import read_table
from rga.records.table import Table
from rga.records.times import read_clock

START = np.datetime64("2024-02-01T10:00:00")
TIMES = {"wf_start_time": START, "wf_increment": 0.5}
HOUR = np.timedelta64(1, "h")


def table(path: Path, data: bytes, **stated: Any) -> Table:
    path.write_bytes(data)
    return read_table(path, RecordMapping(**stated))


def begin(found: Table) -> tuple[str | float, list[float]]:
    clock = read_clock(found, TimeColumns())
    return clock.start, clock.seconds.tolist()


def part(rows: dict[str, int], stated: dict[str, Any], *others: Any) -> bytes:
    """A part of a file: channels of one group with so many rows each."""
    content = BytesIO()
    with TdmsWriter(content) as writer:
        channels = [
            ChannelObject("g", name, np.arange(float(count)), TIMES | stated)
            for name, count in rows.items()
        ]
        writer.write_segment([*others, *channels])
    return content.getvalue()


def other_order(rows: int, step: float) -> bytes:
    """A part with its bytes the other way round, of the channel S1 without a start."""
    path, name = b"/'g'/'S1'", b"wf_increment"
    channel = struct.pack(">I", len(path)) + path + struct.pack(">IIIQ", 20, 10, 1, rows)
    stated = struct.pack(">II", 1, len(name)) + name + struct.pack(">Id", 10, step)
    said = struct.pack(">I", 1) + channel + stated
    values = np.arange(rows).astype(">f8").tobytes()
    flags = 1 << 1 | 1 << 2 | 1 << 3 | 1 << 6
    return (
        struct.pack("<4sI", b"TDSm", flags)
        + struct.pack(">IQQ", 4713, len(said) + len(values), len(said))
        + said
        + values
    )


def test_groups_of_two_rates(tmp_path: Path) -> None:
    fast = {"wf_start_time": START, "wf_increment": 0.01}
    with TdmsWriter(tmp_path / "w.tdms") as writer:
        writer.write_segment(
            [
                ChannelObject("g", "S1", np.arange(4.0), {**fast, "unit_string": "µm/m"}),
                ChannelObject("g", "S2", np.arange(4.0) * 2, fast),
                ChannelObject("slow", "T", np.array([20.0, 21.0]), {**fast, "wf_increment": 1.0}),
            ]
        )
    data = (tmp_path / "w.tdms").read_bytes()
    found = table(tmp_path / "r.tdms", data)
    assert found.frame.columns == ["S1", "S2"]
    assert found.units == {"S1": "µm/m"}
    assert begin(found) == ("2024-02-01T10:00:00+00:00", [0, 0.01, 0.02, 0.03])
    assert table(tmp_path / "r.tdms", data, block=2).frame.columns == ["T"]
    cut = table(tmp_path / "r.tdms", data[:-12])
    assert "the file is not whole" in " ".join(cut.warnings)


BOTH = {"S1": 5, "S2": 5}


@pytest.mark.parametrize(
    ("parts", "found"),
    [
        ([part(BOTH, {}), part(BOTH, {})], 10),
        ([part(BOTH, {"unit_string": "mm"}), part(BOTH, {}), part(BOTH, {"remark": "x"})], 15),
        ([part({}, {}, GroupObject("g", {"wf_start_time": START + HOUR})), part(BOTH, {})], 5),
        ([part({"S1": 0, "S2": 0}, {"wf_increment": 2.0}), part(BOTH, {})], 5),
        (
            [part(BOTH, {}), part({"S1": 5}, {}), part({"S1": 5, "S2": 10}, {})],
            "part 2 of the file has 0 rows of 'S2' beside 5 of 'S1'",
        ),
        ([part(BOTH, {}), part(BOTH, {"wf_start_time": START + HOUR})], "wf_start_time of 'S1'"),
        (
            [
                part(BOTH, {}, RootObject({"wf_start_time": START})),
                part(BOTH, {"wf_start_time": START + HOUR}),
            ],
            "part 2 of the file states another wf_start_time",
        ),
        (
            [part(BOTH, {}), part(BOTH, {"wf_start_time": START + np.timedelta64(500, "ms")})],
            "another wf_start_time",
        ),
        (
            [part(BOTH, {"wf_start_offset": 0.0}), part(BOTH, {"wf_start_offset": 3600.0})],
            "another wf_start_offset",
        ),
        ([part(BOTH, {}), part(BOTH, {"wf_increment": 2.0})], "another wf_increment"),
        ([part(BOTH, {"unit_string": "mm"}), part(BOTH, {"unit_string": "cm"})], "unit_string"),
        (
            [part(BOTH, {"NI_Scale[0]_Linear_Slope": slope}) for slope in (1.0, 2.0)],
            "another NI_Scale\\[0\\]_Linear_Slope",
        ),
    ],
)
def test_parts_belong_together(parts: list[bytes], found: int | str, tmp_path: Path) -> None:
    if isinstance(found, int):
        assert len(table(tmp_path / "r.tdms", b"".join(parts)).frame) == found
    else:
        with pytest.raises(InputError, match=found):
            table(tmp_path / "r.tdms", b"".join(parts))


def test_parts_are_told_of_as_they_were_written() -> None:
    data = part(BOTH, {"unit_string": "mm"}) + part({"S2": 3}, {}) + other_order(7, 0.5)
    parts = list(parts_of(data))
    assert [{path: one.length for path, one in part.rows.items()} for part in parts] == [
        {"/'g'/'S1'": 5, "/'g'/'S2'": 5},
        {"/'g'/'S2'": 3},
        {"/'g'/'S1'": 7},
    ]
    file = TdmsFile.read(BytesIO(data))
    for name in BOTH:
        assert sum(one.rows.get(f"/'g'/'{name}'", Values()).length for one in parts) == len(
            file["g"][name]
        )
    kind, step = parts[2].properties["/'g'/'S1'"]["wf_increment"]
    assert (kind, struct.unpack("<d", step)) == (10, (0.5,))


@pytest.mark.parametrize("count", [1, 2])
def test_chunks_of_one_value_are_rows(count: int) -> None:
    data = part({"S1": count, "S2": count}, {})
    begin = len(data) - 16 * count
    many = np.random.default_rng(1).standard_normal(2 * count * 50).tobytes()
    data = data[:12] + struct.pack("<Q", begin - 28 + len(many)) + data[20:begin] + many
    together = with_rows_together(data, list(parts_of(data)))
    assert (together is data) == (count == 2)
    apart, read = (TdmsFile.read(BytesIO(one))["g"] for one in (data, together))
    for name in BOTH:
        assert len(read[name]) == 50 * count
        np.testing.assert_array_equal(read[name][:], apart[name][:])


@pytest.mark.parametrize("step", [0.5, 5.0])
def test_the_order_of_bytes_says_nothing_of_what_is_stated(step: float, tmp_path: Path) -> None:
    data = part({"S1": 5}, {}) + other_order(5, step)
    if step == 0.5:
        assert len(table(tmp_path / "r.tdms", data).frame) == 10
    else:
        with pytest.raises(InputError, match="another wf_increment of 'S1'"):
            table(tmp_path / "r.tdms", data)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (part({"S1": 5}, {"NI_Number_Of_Scales": 2**28}), "has more than 100 scales"),
        (other_order(5, 0.5).replace(struct.pack(">Q", 5), struct.pack(">Q", 2**40)), "far more"),
        (part({"S1": 5}, {}) + b"TDSx" + bytes(60), "does not begin as it should"),
        (part({"S1": 5}, {})[:90], "no channel with numbers"),
    ],
)
def test_damaged_files_are_refused_before_they_take_memory(
    data: bytes, said: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=said):
        table(tmp_path / "r.tdms", data)


@pytest.mark.parametrize("late", [False, True])
def test_channels_of_one_name_are_counted_by_their_groups(late: bool, tmp_path: Path) -> None:
    with TdmsWriter(tmp_path / "w.tdms") as writer:
        for rows in ([("a", 5), ("b", 0 if late else 5)], [("a", 5), ("b", 10 if late else 5)]):
            writer.write_segment(
                [ChannelObject(group, "S1", np.arange(float(count))) for group, count in rows]
            )
    if late:
        with pytest.raises(InputError, match="part 1 of the file has 0 rows of 'b/S1' beside 5"):
            read_table(tmp_path / "w.tdms")
    else:
        assert read_table(tmp_path / "w.tdms").frame.columns == ["a/S1", "b/S1"]


def test_groups_and_the_file_may_state_times_of_their_own(tmp_path: Path) -> None:
    begins = [{"wf_start_time": np.datetime64(f"2024-0{k}-01T10:00:00")} for k in (1, 2, 3)]
    channel = ChannelObject("g", "S1", np.arange(4.0), begins[2] | {"wf_increment": 0.5})
    with TdmsWriter(tmp_path / "w.tdms") as writer:
        writer.write_segment([RootObject(begins[0]), GroupObject("g", begins[1]), channel])
    found = read_table(tmp_path / "w.tdms")
    assert begin(found) == ("2024-03-01T10:00:00+00:00", [0, 0.5, 1, 1.5])


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ({"wf_start_time": "noon"}, (0.0, [0, 0.5])),
        ({"wf_start_time": np.datetime64("1904-01-01")}, (0.0, [0, 0.5])),
        ({"wf_start_offset": float("nan")}, (0.0, [0, 0.5])),
        ({"wf_increment": "x"}, "nan s lie between its rows"),
        ({"wf_increment": -1.0}, "-1 s lie between its rows"),
        ({"wf_increment": 0.0}, "there is no time column 'time'"),
        ({"wf_increment": 1e-12}, "1e-12 s lie between its rows"),
        ({"wf_increment": 5e-7}, ("2024-02-01T10:00:00+00:00", [0, 5e-7])),
        ({"wf_increment": float("inf")}, "inf s lie between its rows"),
    ],
)
def test_times_that_are_none(said: dict[str, Any], found: Any, tmp_path: Path) -> None:
    times = TIMES
    with TdmsWriter(tmp_path / "w.tdms") as writer:
        writer.write_segment([ChannelObject("g", "S1", np.arange(2.0), times | said)])
    read = read_table(tmp_path / "w.tdms")
    if isinstance(found, str):
        with pytest.raises(InputError, match=found):
            begin(read)
        assert read_clock(read, TimeColumns(sampling_rate_hz=4)).seconds.tolist() == [0, 0.25]
    else:
        assert begin(read) == found
        assert ("cannot be read" in " ".join(read.notes)) == (found[0] == 0.0)
