"""Formats of others: what they say, and what is refused in a line."""

import json
from datetime import timedelta, timezone
from typing import Any
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rga.errors import InputError
from rga.operation.packets.csv_row import file_of_row
from rga.operation.packets.formats import (
    PACKETS,
    PayloadFormat,
    StatedFormat,
    format_of_bytes,
    format_of_type,
    read_packets,
)
from rga.operation.packets.line_protocol import read_line_protocol
from rga.operation.packets.packet import MOST_BYTES, SensorPacket
from rga.operation.packets.senml import read_senml
from rga.operation.packets.sensorthings import read_sensorthings
from rga.operation.packets.topics import TopicPattern, read_number

#: 2026-11-23T00:00:00Z, and when payloads arrive [microseconds since 1970]
MIDNIGHT = 1_795_392_000_000_000
NOW = MIDNIGHT + 3_600_000_000
SECOND = 1_000_000
STAMP = "2026-11-23T00:00:00Z"


def readings(packets: list[SensorPacket]) -> dict[str, list[tuple[int, float]]]:
    """Moments since midnight [µs] and values, by channel."""
    found: dict[str, list[tuple[int, float]]] = {}
    for packet in packets:
        for k, name in enumerate(packet.channels):
            pairs = zip(packet.times - MIDNIGHT, packet.values[:, k], strict=True)
            found.setdefault(name, []).extend((int(time), float(value)) for time, value in pairs)
    return found


def said(content: Any) -> bytes:
    return json.dumps(content).encode()


def test_base_fields_of_senml_hold_until_others_come() -> None:
    pack = [
        {"bn": "a/", "bt": MIDNIGHT / 1e6, "bu": "mm", "bv": 10, "n": "D1", "v": 1.5},
        {"n": "D2", "t": 0.25, "v": -1},
        {"n": "S1", "u": "V", "vs": "text"},
        {"bn": "b/", "bt": MIDNIGHT / 1e6 + 60, "bv": 0, "n": "D1", "u": "m", "v": 2},
        {"n": "D1", "t": -1, "u": "m", "v": 3, "unknown": 1},
    ]
    packets = read_senml(said(pack), "a test", NOW)
    assert readings(packets) == {
        "a/D1": [(0, 11.5)],
        "a/D2": [(250_000, 9.0)],
        "b/D1": [(59 * SECOND, 3.0), (60 * SECOND, 2.0)],
    }
    units = {name: unit for one in packets for name, unit in one.units.items()}
    assert units == {"a/D1": "mm", "a/D2": "mm", "b/D1": "m"}
    assert all(one.timed and one.number is None for one in packets)


def test_relative_times_of_senml_refer_to_the_arrival() -> None:
    pack = said([{"n": "D1", "v": 1}, {"n": "D1", "t": -5, "v": 2}])
    packets = read_senml(pack, "a test", MIDNIGHT)
    assert readings(packets) == {"D1": [(-5 * SECOND, 2.0), (0, 1.0)]}
    assert not any(one.timed for one in packets)


@pytest.mark.parametrize(
    ("pack", "words"),
    [
        (b"", "no SenML"),
        (b"[" * 100_000, "no SenML"),
        (b'[{"n":"D1","v":' + b"[" * 100_000, "no SenML"),
        (said([{"n": "D1", "v": [1]}]), "no SenML"),
        (said([{"n": "D1", "v": "1"}]), "'1' is no number"),
        (said([{"n": "D1", "v": True}]), "'True' is no number"),
        (b'[{"n":"D1","v":1e999}]', "no SenML"),
        (said([{"n": "D1", "v": 1e31}]), "is no number"),
        (said([{"v": 1}]), "no name"),
        (said([{"n": 5, "v": 1}]), "no text"),
        (said([{"n": "x" * 201, "v": 1}]), "201 letters"),
        (said([{"n": "D1", "vs": "x"}]), "no number in it"),
        (said([]), "no number in it"),
        (said([{"bver": 11, "n": "D1", "v": 1}]), "version 11"),
        (said([{"n": "D1", "v": 1, "must_": 1}]), "must be understood"),
        (said([{"n": "D1", "u": "m", "v": 1}, {"n": "D1", "u": "mm", "v": 1}]), "'m' and in 'mm'"),
        (said([{"n": "D1", "t": 1e12, "v": 1}]), "outside the years"),
        (said([{"n": "D1", "v": 1}, {"n": "D1", "t": -86_401, "v": 1}]), "86400 are allowed"),
        (b"[" + b" " * MOST_BYTES, "bytes"),
    ],
)
def test_what_is_no_senml_is_refused(pack: bytes, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read_senml(pack, "logger A", NOW)
    assert words in str(refused.value)
    assert "logger A" in str(refused.value)
    assert len(str(refused.value)) < 500


def test_observations_are_read() -> None:
    link = {"Datastream@iot.navigationLink": "http://x/v1.1/Datastreams(7)"}
    named = {"Datastream": {"name": "D1", "unitOfMeasurement": {"symbol": "mm"}}}
    entries = [
        {"result": 1.5, "phenomenonTime": STAMP, **link},
        {"result": 2, "phenomenonTime": f"2026-11-22T23:59:00Z/{STAMP}", **named},
        {"result": None, "phenomenonTime": "2026-11-23T01:00:01+01:00", **named},
    ]
    for content in (entries, {"value": entries}):
        packets = read_sensorthings(said(content), "a test", NOW, None)
        found = readings(packets)
        assert found["Datastreams(7)"] == [(0, 1.5)]
        assert found["D1"][0] == (0, 2.0)
        assert found["D1"][1][0] == SECOND
        assert np.isnan(found["D1"][1][1])
        assert {"D1": "mm"} in [dict(one.units) for one in packets]


def test_a_topic_may_name_the_data_stream() -> None:
    payload = said({"result": 1.5})
    (packet,) = read_sensorthings(payload, "v1.1/Datastreams(7)/Observations", NOW, None)
    assert (packet.channels, packet.times.tolist()) == (("Datastreams(7)",), [NOW])
    assert not packet.timed


def test_a_data_array_is_read() -> None:
    content = [
        {
            "Datastream": {"@iot.id": "a"},
            "components": ["phenomenonTime", "result", "resultQuality"],
            "dataArray@iot.count": 2,
            "dataArray": [[STAMP, 1.5, {"x": 1}], ["2026-11-23T00:00:01Z", 2.5, None]],
        }
    ]
    packets = read_sensorthings(said(content), "a test", NOW, None)
    assert readings(packets) == {"Datastreams(a)": [(0, 1.5), (SECOND, 2.5)]}


ONE = {"result": 1.0, "phenomenonTime": STAMP, "Datastream": {"@iot.id": 1}}
ARRAY = {"Datastream": {"@iot.id": 1}, "components": ["phenomenonTime", "result"]}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "no observations"),
        (b"[" * 100_000, "no observations"),
        (b'{"result":' + b"[" * 100_000, "no observations"),
        (said(5), "no observations"),
        (said({"value": 5}), "no observations"),
        (said(ONE | {"result": "1"}), "no number"),
        (said(ONE | {"result": True}), "no number"),
        (said(ONE | {"result": 1e31}), "nothing measures"),
        (said(ONE | {"phenomenonTime": "2026-11-23T00:00:00"}), "no zone"),
        (said(ONE | {"phenomenonTime": "yesterday"}), "cannot be read"),
        (said(ONE | {"phenomenonTime": 5}), "no text"),
        (said(ONE | {"phenomenonTime": "0001-01-01T00:00:00Z"}), "outside the years"),
        (said({"result": 1.0, "phenomenonTime": STAMP}), "no data stream"),
        (said({"phenomenonTime": STAMP, "Datastream": {"@iot.id": 1}}), "no result"),
        (said([{"dataArray": []}]), "no data stream"),
        (said([{**ARRAY, "components": 5, "dataArray": []}]), "no components"),
        (said([{**ARRAY, "components": ["id"], "dataArray": []}]), "no result"),
        (said([{**ARRAY, "dataArray": [[STAMP]]}]), "not 2 places"),
        (said([{**ARRAY, "dataArray": []}]), "no number in it"),
    ],
)
def test_what_is_no_observation_is_refused(content: bytes, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read_sensorthings(content, "logger A", NOW, None)
    assert words in str(refused.value)


def test_line_protocol_is_read() -> None:
    lines = (
        "# a comment\n"
        rf"east,sensor=D1,place=north\ side v=1.5,i=-3i,u=4u,ok=true,t=\"a,b c=1\" {MIDNIGHT}000"
        "\n\n"
        rf"we\,st a\ b=.5e1 {MIDNIGHT + SECOND}000"
        "\r\n"
    ).replace('\\"', '"')
    packets = read_line_protocol(lines.encode(), "a test", NOW)
    assert readings(packets) == {
        "east D1 north side v": [(0, 1.5)],
        "east D1 north side i": [(0, -3.0)],
        "east D1 north side u": [(0, 4.0)],
        "we,st a b": [(SECOND, 5.0)],
    }
    (packet,) = read_line_protocol(b"east v=1", "a test", NOW)
    assert (packet.times.tolist(), packet.timed) == ([NOW], False)


@pytest.mark.parametrize("digits", [0, 3, 6, 9])
def test_the_precision_of_a_time_is_told_by_its_size(digits: int) -> None:
    stamp = MIDNIGHT // 10**6 * 10**digits
    (packet,) = read_line_protocol(b"a v=1 %d" % stamp, "a test", NOW)
    assert packet.times.tolist() == [MIDNIGHT]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (b"a", "line 1"),
        (b"a v=1\nb", "line 2"),
        (b"a v=", "not of the line protocol"),
        (b"a v=1 2 3", "not of the line protocol"),
        (b"a v=nan 1795392000", "no number"),
        (b"a v=1e31 1795392000", "nothing measures"),
        (b"a v=1e999 1795392000", "nothing measures"),
        (b'a v="x" 1795392000', "no number in it"),
        (b"a v=1 -5", "outside the years"),
        (b"a v=1 9223372036854775807", "outside the years"),
        (b"\xff\xfe v=1", "no UTF-8"),
        (b"a" * (MOST_BYTES + 1), "bytes"),
        (b"," * 100_000, "not of the line protocol"),
    ],
)
def test_what_is_no_line_protocol_is_refused(lines: bytes, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read_line_protocol(lines, "logger A", NOW)
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("payload", "value", "moment"),
    [
        (b"1.5", 1.5, NOW),
        (b" -2e3\n", -2000.0, NOW),
        (b"1.5 2026-11-23T00:00:00Z", 1.5, MIDNIGHT),
        (b"1.5;1795392000.25", 1.5, MIDNIGHT + SECOND // 4),
        (b"1.5, 1795392000000", 1.5, MIDNIGHT),
        (b'{"value": 1.5, "time": "2026-11-23T00:00:00Z"}', 1.5, MIDNIGHT),
        (b'{"value": 1.5, "time": 1795392000}', 1.5, MIDNIGHT),
        (b'{"value": 1.5}', 1.5, NOW),
        (b"1.5 2026-11-23T01:00:00", 1.5, MIDNIGHT),
    ],
)
def test_a_number_is_read(payload: bytes, value: float, moment: int) -> None:
    pattern, zone = TopicPattern("site/+/{channel}/now"), timezone(timedelta(hours=1))
    (packet,) = read_number(payload, "site/east/D1/now", NOW, pattern, zone)
    assert (packet.channels, packet.values.tolist()) == (("D1",), [[value]])
    assert (packet.times.tolist(), packet.timed) == ([moment], moment != NOW)


@pytest.mark.parametrize(
    ("more", "units"),
    [
        ('"unit": "cm"', {"D1": "cm"}),
        ('"u": "cm"', {"D1": "cm"}),
        ('"u": "cm", "unit": "cm"', {"D1": "cm"}),
        ('"unit": null', {}),
        ('"battery": 97', {}),
    ],
)
def test_the_unit_of_a_number_is_that_of_its_channel(more: str, units: dict[str, str]) -> None:
    payload = f'{{"value": 2, "time": 1795392000, {more}}}'.encode()
    assert read_number(payload, "D1", NOW, None, None)[0].units == units


@pytest.mark.parametrize(
    ("payload", "topic", "words"),
    [
        (b"on", "site/D1", "'on' is no number"),
        (b"", "site/D1", "no number"),
        (b"nan", "site/D1", "no number"),
        (b"inf", "site/D1", "no number"),
        (b"1e31", "site/D1", "nothing measures"),
        (b"1 tomorrow", "site/D1", "cannot be read"),
        (b"1 2026-11-23T00:00:00", "site/D1", "no zone"),
        (b"1 99999999999999999999", "site/D1", "no time"),
        (b'{"v": 1}', "site/D1", "no number"),
        (b"1,5", "site/D1", "'5' behind the number is no time"),
        (b"1,570796326", "site/D1", "write numbers with a point"),
        (b"1,5 2026-11-23T00:00:00Z", "site/D1", "cannot be read"),
        (b'{"value": 1, "unit": 5}', "site/D1", "no number"),
        (b'{"value": 1, "unit": "cm", "u": "mm"}', "site/D1", "it is in 'cm' and 'mm'"),
        (b"1" * 2000, "site/D1", "no number"),
        (b"\xff", "site/D1", "no number"),
        (b"1", "site/a/D1", "not of 'site/{channel}'"),
        (b"1", "other/D1", "not of 'site/{channel}'"),
    ],
)
def test_what_is_no_number_is_refused(payload: bytes, topic: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read_number(payload, topic, NOW, TopicPattern("site/{channel}"), None)
    assert words in str(refused.value)


@pytest.mark.parametrize("pattern", ["site", "{channel}/{channel}", "a/x{channel}", "#/{channel}"])
def test_a_pattern_names_one_channel(pattern: str) -> None:
    with pytest.raises(ValueError, match="as one level"):
        TopicPattern(pattern)


def test_an_hour_that_exists_twice_or_never_is_refused() -> None:
    zone = ZoneInfo("Europe/Berlin")
    for stamp, words in (("2026-10-25T02:30", "exists twice"), ("2026-03-29T02:30", "not exist")):
        with pytest.raises(InputError, match=words):
            read_number(f"1 {stamp}".encode(), "D1", NOW, None, zone)
        told = read_number(f"1 {stamp}+02:00".encode(), "D1", NOW, None, zone)
        assert told[0].timed


def test_rows_get_the_names_of_their_columns() -> None:
    found = file_of_row(b"0,1\n1,2\n", "a test", NOW, ["time", "D1"], ["time"], None)
    assert found == (b"time,D1\n0,1\n1,2\n", True)
    for rows, words in ((b"1,2,3", "not the 2 columns"), (b"", "not the 2"), (b"1", "not the 2")):
        with pytest.raises(InputError, match=words):
            file_of_row(rows, "a test", NOW, ["time", "D1"], ["time"], None)
    with pytest.raises(InputError, match="2 rows have no times"):
        file_of_row(b"1\n2\n", "a test", NOW, ["D1"], ["time"], None)


@pytest.mark.parametrize(
    ("payload", "expected"),
    [
        (b'{"v": 1, "t0": 1}', "packet"),
        (b"\x81\xa1v\x01", "packet"),
        (b'[{"bn": "a"}]', "senml"),
        (b' [ { "n":"a","v":1}]', "senml"),
        (b'{"result": 1, "phenomenonTime": "x"}', "sensorthings"),
        (b'[{"Datastream": {}, "dataArray": []}]', "sensorthings"),
        (b'{"value": [{"result": 1, "Datastream": {}}]}', "sensorthings"),
        (b"# c\nair,id=1 t=71.2 5", "line_protocol"),
        (b"time,D1\n0,1\n", "file"),
        (b'"TOA5","a"\n', "file"),
        (b"\x00\xff", "file"),
        (b"", "file"),
    ],
)
def test_a_format_is_known_by_its_bytes(payload: bytes, expected: PayloadFormat) -> None:
    assert format_of_bytes(payload) == expected


def test_a_content_type_names_a_format() -> None:
    assert format_of_type("application/vnd.influx.line-protocol") == "line_protocol"
    assert format_of_type("Application/MsgPack") == "packet"
    assert format_of_type("application/json") is None
    assert format_of_type(None) is None


@settings(max_examples=50)
@given(st.binary(max_size=200) | st.text(max_size=200).map(str.encode), st.sampled_from(PACKETS))
def test_bytes_are_read_or_refused(payload: bytes, kind: PayloadFormat) -> None:
    try:
        packets = read_packets(kind, payload, "D1", NOW, StatedFormat())
    except InputError:
        return
    assert packets
    assert all(np.isfinite(one.times).all() for one in packets)


@settings(max_examples=50)
@given(
    st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, 3), st.floats(-1e9, 1e9)), min_size=1)
)
def test_every_reading_of_a_payload_comes_out(points: list[tuple[str, int, float]]) -> None:
    lines = [f"m {name}={value!r} {MIDNIGHT + time}" for name, time, value in points]
    found = readings(read_line_protocol("\n".join(lines).encode(), "a test", NOW))
    expected: dict[str, list[tuple[int, float]]] = {}
    for name, time, value in points:
        expected.setdefault(f"m {name}", []).append((time, value))
    assert {name: sorted(one) for name, one in found.items()} == {
        name: sorted(one) for name, one in expected.items()
    }
    # Of one moment, the first that was written comes first.
    for name, own in expected.items():
        for moment in {time for time, _ in own}:
            of_moment = [value for time, value in own if time == moment]
            assert [value for time, value in found[name] if time == moment] == of_moment
