"""Mappings by which nothing could be read are refused before anything is."""

from pathlib import Path

import pytest

from rga.errors import InputError
from rga.records.mapping import TIMES, mapping_of
from rga.records.times.counted import COUNTED, SECONDS


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            '[channels]\nA = { column = "x" }\nB = { column = "x" }',
            "the channels 'A' and 'B' both name the column 'x'",
        ),
        ('[channels]\nA = { column = "" }', "channels.A.column: name the column"),
        ('[channels]\nA = { column = " " }', "channels.A.column: name the column"),
        ('[time]\nformat = "%Q"', "time.format: '%Q' is no pattern"),
        ('[time]\nformat = "%d.%m.%d"', "time.format: '%d.%m.%d' is no pattern"),
        ('[time]\nformat = "excell"', "nor one of excel, unix"),
        ('[time]\nformat = ""', "time.format: '' is no pattern"),
        ('[time]\nzone = "Europe/Atlantis"', "time.zone: there is no time zone 'Europe/Atlantis'"),
    ],
)
def test_what_reads_nothing_is_refused(text: str, told: str) -> None:
    with pytest.raises(InputError) as raised:
        mapping_of(text, Path("bridge/import.toml"))
    assert told in str(raised.value)
    assert raised.value.where == "bridge/import.toml"


@pytest.mark.parametrize(
    "text",
    [
        '[channels]\nA = { column = "x" }\n[unused]\nx = "TO CHECK: no name is like it"',
        '[channels]\nA = { column = "B" }\nB = { column = "A" }',
        '[time]\nformat = "%Y-%m-%dT%H:%M:%S.%f%z"',
        '[time]\nformat = "%H:%M"',
        '[time]\nformat = "%y%j%I%p"',
        '[time]\nzone = "+01:00"',
    ],
)
def test_what_reads_something_is_taken(text: str) -> None:
    mapping_of(text, Path("import.toml"))


@pytest.mark.parametrize("left_out", ["A", "x"])
def test_a_channel_that_a_person_leaves_out_stays_out(left_out: str) -> None:
    text = f'[channels]\nA = {{ column = "x" }}\nB = {{}}\n[unused]\n{left_out} = "broken"'
    assert mapping_of(text, Path("import.toml")).overruled == ["A"]


def test_formats_that_are_no_patterns_are_those_that_are_read() -> None:
    assert {*TIMES} == {*COUNTED, SECONDS}
