"""The packet of rga's own: what is written is read, and what is none is refused in a line."""

import json

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from rga.errors import InputError
from rga.operation.packets.native import is_native, packet_schema, read_packet, write_packet
from rga.operation.packets.packet import MOST_BYTES, Number, SensorPacket

SOUND = {
    "v": 1,
    "stream": "a1",
    "seq": 7,
    "t0": "2026-11-23T01:00:00+01:00",
    "dt": 0.004,
    "channels": ["D1", "D2"],
    "values": [[1.5, None], [2.5, -3.0]],
}
#: 2026-11-23T00:00:00Z [microseconds since 1970]
MIDNIGHT = 1_795_392_000_000_000


def said(**changes: object) -> bytes:
    return json.dumps({key: one for key, one in (SOUND | changes).items() if one != "-"}).encode()


def test_a_packet_is_read() -> None:
    packet = read_packet(said(), "a test")
    assert packet.number == Number("a1", 7)
    assert packet.channels == ("D1", "D2")
    assert packet.times.tolist() == [MIDNIGHT, MIDNIGHT + 4000]
    np.testing.assert_array_equal(packet.values, [[1.5, np.nan], [2.5, -3.0]])
    assert is_native(said())


@pytest.mark.parametrize("binary", [False, True], ids=["JSON", "MessagePack"])
@pytest.mark.parametrize("single", [False, True], ids=["numbers", "float32"])
@given(
    steps=st.lists(st.integers(1, 10_000_000), max_size=5),
    values=st.lists(st.none() | st.floats(-(2.0**99), 2.0**99, width=32), min_size=12, max_size=12),
    number=st.none() | st.builds(Number, st.just("x-1"), st.integers(0, 2**53 - 1)),
)
def test_what_is_written_is_read(
    binary: bool,
    single: bool,
    steps: list[int],
    values: list[float | None],
    number: Number | None,
) -> None:
    times = MIDNIGHT + np.cumsum([0, *steps])
    readings = np.array(values[: 2 * len(times)], dtype=float).reshape(-1, 2)
    sent = SensorPacket(number, ("D1", "a b"), times, readings)
    payload = write_packet(sent, binary=binary, single=single)
    assert is_native(payload)
    got = read_packet(payload, "a test")
    assert (got.number, got.channels) == (sent.number, sent.channels)
    np.testing.assert_array_equal(got.times, sent.times)
    np.testing.assert_array_equal(got.values, sent.values)
    if not binary:
        Draft202012Validator(packet_schema()).validate(json.loads(payload))


def test_a_channel_may_be_called_as_a_key_is() -> None:
    packet = read_packet(said(channels=["seq", "a\u00e9"]), "logger A")
    assert packet.channels == ("seq", "a\u00e9")


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        (b"", "no packet"),
        (b"\xff\xfe", "no packet"),
        (b'{"v": 1', "no packet"),
        (b"[" * 100_000, "no packet"),
        (b'{"v": ' * 100_000, "no packet"),
        (b"\x81" * 100_000, "no packet"),
        (said(v=2), "no packet"),
        (said(extra=1), "extra"),
        (said(t0="2026-11-23T00:00:00"), "timezone"),
        (said(t0="2026-13-23T00:00:00Z"), "no packet"),
        (said(channels=[]), "no packet"),
        (said(channels=["D1", "D1"]), "twice"),
        (said(channels=["D1", "x" * 201]), "no packet"),
        (said(values=[]), "no packet"),
        (said(values=[[1.0]]), "a row has 1 readings"),
        (said(values=[[1.0, True]]), "no packet"),
        (said(values=[[1.0, "2"]]), "no packet"),
        (said(values="AAAA"), "no rows of 2 float32"),
        (said(values=[[1.0, 1e31], [0.0, 0.0]]), "nothing measures 1e+31"),
        (said().replace(b"-3.0", b"1e999"), "no packet"),
        (said(dt=0), "no packet"),
        (said(dt=61), "no packet"),
        (said(dt="-"), "no times"),
        (said(dt=1e-9), "do not rise"),
        (said(t=[0.0, 1.0]), "dt and t"),
        (said(dt="-", t=[0.0]), "2 rows have 1 times"),
        (said(dt="-", t=[1.0, 0.5]), "do not rise"),
        (said(dt="-", t=[0.0, 60.5]), "longer than 60 s"),
        (said(seq=-1), "no packet"),
        (said(seq=2**53), "no packet"),
        (said(seq="-"), "it has no seq"),
        (said().replace(b'"dt"', b'"seq": 3, "dt"'), "the key 'seq' stands twice"),
        (said().replace(b'"dt"', b'"s\\u0065q": 3, "dt"'), "the key 'seq' stands twice"),
        (said(stream="-"), "it has no stream"),
        (said(stream="../up"), "no packet"),
        (b"{" + b" " * MOST_BYTES, "bytes"),
        (msgspec.msgpack.encode(SOUND | {"t0": "x"}), "no packet"),
        (msgspec.msgpack.encode({**SOUND, "values": np.float32([1, np.inf]).tobytes()}), "nothing"),
    ],
)
def test_what_is_no_packet_is_refused(payload: bytes, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read_packet(payload, "logger A")
    assert words in str(refused.value)
    assert "logger A" in str(refused.value)
    assert len(str(refused.value)) < 500
