"""Every channel of a record on the page, whatever it holds."""

import base64
import re
from io import BytesIO
from types import SimpleNamespace
from typing import cast

import numpy as np
import polars as pl
import pytest

from rga.arrays import FloatArray
from rga.findings import Findings
from rga.records import Record
from rga.report.figures.channels import MOST_NUMBERS, POINTS, Channels, all_channels

NAME = '<script>"D" & 1'


def channels(readings: FloatArray) -> Channels:
    """Of one sensor, simulated as zero before and as read after."""
    rows = len(readings)
    record = Record(
        60.0 * np.arange(rows), "2026-03-01T00:00:00", "iso", (NAME,), readings[:, None], {}
    )
    account = SimpleNamespace(
        record=record,
        model=SimpleNamespace(sensors={NAME: SimpleNamespace(unit="mm")}),
        before=np.zeros((rows, 1)),
        after=readings[:, None],
    )
    return all_channels(cast(Findings, SimpleNamespace(account=account)))


def table(found: Channels) -> pl.DataFrame:
    _, _, content = found.each[0].table.partition(",")
    return pl.read_csv(BytesIO(base64.b64decode(content)))


class TestChannels:
    def test_a_file_holds_every_row(self) -> None:
        readings = np.array([1.25e-7, np.nan, -3.0])
        found = table(channels(readings))
        assert found["time"].to_list() == [f"2026-03-01T00:0{k}:00" for k in range(3)]
        assert found["measured"].to_list() == [1.25e-7, None, -3.0]
        assert found["as given"].to_list() == [0.0, 0.0, 0.0]

    def test_a_line_breaks_where_readings_are_missing(self) -> None:
        (measured, given, _) = re.findall(
            r'd="([^"]*)" fill="none" stroke="#(?!d0)',
            channels(np.array([1, np.nan, 2])).each[0].figure,
        )
        assert (measured.count("M"), given.count("M")) == (2, 1)

    def test_of_many_rows_nothing_that_sticks_out_is_lost(self) -> None:
        readings = np.zeros(100_000)
        readings[77_777] = 5.0
        found = channels(readings)
        assert found.every == -(-4 * 100_000 // MOST_NUMBERS) == 20
        assert len(table(found)) == -(-100_000 // 20)
        drawn = str(found.each[0].figure)
        assert len(re.findall("[ML]", drawn.split('stroke="#8c959f"')[0])) < POINTS + 10
        highest = min(float(y) for y in re.findall(r"L[\d.]+ ([\d.]+)", drawn))
        assert highest < 10.0  # near the top of the figure

    @pytest.mark.parametrize("readings", [[np.nan, np.nan], [7.0, 7.0], [1e300, -1e300]])
    def test_any_readings_make_a_figure_of_finite_numbers(self, readings: list[float]) -> None:
        figure = str(channels(np.array(readings)).each[0].figure)
        assert "nan" not in figure
        assert "inf" not in figure

    def test_names_cannot_break_the_page(self) -> None:
        assert "<script>" not in channels(np.ones(2)).each[0].figure
