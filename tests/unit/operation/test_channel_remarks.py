"""Channels and units that cannot be used: the rest is, and each is told."""

from typing import Any

import numpy as np
import pytest

from rga.errors import InputError, SeveralMistakes
from rga.model import Model, read_model
from rga.operation.inbox.arrival import Arrival
from rga.operation.packets.formats import PayloadFormat, StatedFormat
from rga.operation.rows.samples import Reader
from rga.operation.sources.arrivals import arrival_of
from rga.records.mapping import Channel, RecordMapping

#: 2026-11-23T00:00:00Z
MIDNIGHT = 1_795_392_000_000_000
STAMP = "2026-11-23T00:00:00Z"


@pytest.fixture(scope="module")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "measured bridge")


def reader_of(model: Model, stated: StatedFormat | None = None, **channels: Channel) -> Reader:
    mapping = RecordMapping(channels=channels, unused={"spare": "not mounted"})
    return Reader("logger", model, mapping, stated)


def came(reader: Reader, text: str, kind: PayloadFormat | None = None) -> Arrival:
    return arrival_of(text.encode(), MIDNIGHT, "a test", reader, None, kind)


def test_a_column_whose_unit_is_none_of_its_sensor_is_left_out(model: Model) -> None:
    reader = reader_of(model)
    text = f"time,D1 [mm],D2 [kg]\n{STAMP},1.5,2.5\n"
    assert came(reader, text).refused is None
    samples, _ = reader.of_rows("file", text.encode(), "a test", MIDNIGHT)
    assert samples.names == ("D1",)
    np.testing.assert_array_equal(samples.values, [[1.5]])
    assert set(reader.remarks.refused) == {"D2 [kg]"}
    assert "'kg'" in reader.remarks.refused["D2 [kg]"]


def test_a_column_whose_name_and_line_of_units_differ_is_left_out(model: Model) -> None:
    reader = reader_of(model)
    text = f"time;D1 [mm];D2\n;cm;mm\n{STAMP};1.5;2.5\n"
    assert came(reader, text).refused is None
    samples, _ = reader.of_rows("file", text.encode(), "a test", MIDNIGHT)
    assert samples.names == ("D2",)
    assert "says 'mm', the line of units says 'cm'" in reader.remarks.refused["D1 [mm]"]


def test_a_unit_in_the_name_of_a_channel_counts_in_packets_too(model: Model) -> None:
    reader = reader_of(model)
    text = f'{{"v": 1, "t0": "{STAMP}", "channels": ["D1 [cm]"], "values": [[1.5]]}}'
    packets = reader.packets_of("packet", text.encode(), "a test", MIDNIGHT)
    (samples,) = reader.of_packets(packets)
    assert samples.names == ("D1",)
    np.testing.assert_array_equal(samples.values, [[15.0]])


@pytest.mark.parametrize(
    ("text", "column"),
    [
        (f"time,D1 [mm]\n{STAMP},1.5\n", "D1 [mm]"),
        (f"time;D1\n;mm\n{STAMP};1.5\n", "D1"),
        ('[{"bt":1795392000,"n":"D1","u":"mm","v":1.5}]', "D1"),
        (
            f'{{"v": 1, "t0": "{STAMP}", "channels": ["D1 (mm)"], "values": [[1.5]]}}',
            "D1 (mm)",
        ),
    ],
)
def test_a_unit_that_import_toml_outweighs_is_told(model: Model, text: str, column: str) -> None:
    for unit, doubted in (("cm", {column}), ("mm", set())):
        reader = reader_of(model, D1=Channel(unit=unit))
        assert came(reader, text).refused is None
        assert set(reader.remarks.doubted) == doubted, unit
    reader = reader_of(model, D1=Channel(unit="cm"))
    came(reader, text)
    assert "import.toml says cm, and what comes says mm" in reader.remarks.doubted[column]


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ('[{"bt":1795392000,"n":"D9","v":1.5}]', None),
        ('[{"bt":1795392000,"n":"D1","u":"kg","v":1.5}]', None),
        (f"time,D9\n{STAMP},1.5\n", None),
        (f"time,D9,spare\n{STAMP},1.5,1\n", "file"),
    ],
)
def test_a_payload_of_which_nothing_is_used_is_refused(
    model: Model, text: str, kind: PayloadFormat | None
) -> None:
    refused = came(reader_of(model), text, kind).refused
    assert refused is not None
    assert "none of its channels is used: D" in refused


def test_every_reason_is_told_why_nothing_of_a_payload_is_used(model: Model) -> None:
    names = '"D1 (kg)", "qq", "rr"'
    text = f'{{"v": 1, "t0": "{STAMP}", "channels": [{names}], "values": [[1, 2, 3]]}}'
    refused = came(reader_of(model), text).refused
    assert refused is not None
    assert "qq and 1 more (the model has no such channel)" in refused
    assert "D1 (kg) (the unit 'kg'" in refused


@pytest.mark.parametrize(
    "text", ['[{"bt":1795392000,"n":"spare","v":1.5}]', f"time,spare\n{STAMP},1.5\n"]
)
def test_a_payload_that_is_left_out_as_a_whole_is_no_mistake(model: Model, text: str) -> None:
    reader = reader_of(model)
    assert came(reader, text).refused is None
    assert reader.remarks.refused == {}


def test_a_row_may_be_sent_as_text_csv(model: Model) -> None:
    stated = StatedFormat("row", columns=("time", "D1", "D2"))
    reader = reader_of(model, stated)
    assert came(reader, f"{STAMP},1.5,2.5", "file").refused is None
    assert reader.stated_names() == {"D1", "D2"}


def test_a_mapping_that_speaks_of_what_is_not_there_is_refused_at_the_start(model: Model) -> None:
    with pytest.raises(InputError, match="'D9', which the model does not have"):
        reader_of(model, D9=Channel(column="ch 9"))
    with pytest.raises(InputError, match="'kg' of 'D1' is not one of a displacement"):
        reader_of(model, D1=Channel(unit="kg"))
    with pytest.raises(SeveralMistakes, match="2 mistakes"):
        reader_of(model, D9=Channel(), D1=Channel(unit="furlong"))


def test_a_file_without_rows_is_refused_in_words(model: Model) -> None:
    refused = came(reader_of(model), "time,D1\n,cm\n").refused
    assert refused is not None
    assert "there are no rows below the header" in refused
