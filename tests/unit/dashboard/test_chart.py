"""Charts that the server draws."""

from datetime import UTC, datetime

import numpy as np
import pytest

from rga.dashboard.svg.chart import HIGH, WIDE, ChartMark, Column, Window, chart

WINDOW = Window(datetime(2026, 11, 23, tzinfo=UTC), 0.0, 100.0)


def line(values: list[float], **options: object) -> str:
    column = np.array(values)
    time = np.linspace(0.0, 100.0, len(values))
    drawn = chart("t", "mm", time, [Column("a", "gap", column, column, column)], WINDOW, **options)  # type: ignore[arg-type]
    return drawn.lines[0].path


def test_larger_is_higher_and_later_is_farther_right() -> None:
    (x0, y0), (x1, y1) = (map(float, one.split()) for one in line([1.0, 2.0])[1:].split("L"))
    assert (x0, x1) == (0.0, WIDE)
    assert 0 < y1 < y0 < HIGH


def test_what_is_missing_is_a_hole() -> None:
    assert line([1.0, 2.0, np.nan, 3.0, 4.0]).count("M") == 2
    assert line([1.0, 2.0, 2.5, 3.0, 4.0]).count("M") == 1
    assert line([np.nan, np.nan]) == ""


def test_a_factor_is_a_step_upwards() -> None:
    path = line([1.0, 10.0, 100.0], logarithmic=True)
    heights = [float(one.split()[1]) for one in path[1:].split("L")]
    assert np.isclose(heights[0] - heights[1], heights[1] - heights[2], atol=0.2)
    assert "nan" not in line([0.0, 1.0], logarithmic=True)


@pytest.mark.parametrize(
    ("values", "ticks"),
    [
        ([0.6, 3.0], ["1", "3", "10"]),
        ([0.2, 40.0], ["0.3", "1", "3", "10", "30"]),
        ([0.2, 2000.0], ["1", "10", "100", "1000"]),
    ],
)
def test_a_scale_of_factors_has_three_ticks_at_least(values: list[float], ticks: list[str]) -> None:
    time, column = np.array([0.0, 100.0]), np.array(values)
    columns = [Column("a", "gap", column, column, column)]
    drawn = chart("t", "", time, columns, WINDOW, logarithmic=True)
    assert [one.words for one in drawn.up] == ticks
    assert drawn.logarithmic


def test_a_band_lies_around_blocks_of_rows_alone() -> None:
    time, mean = np.array([0.0, 50.0]), np.array([1.0, 2.0])
    plain = chart("t", "", time, [Column("a", "gap", mean, mean, mean)], WINDOW)
    blocks = chart("t", "", time, [Column("a", "gap", mean, mean - 1, mean + 1)], WINDOW)
    assert not plain.lines[0].band
    assert blocks.lines[0].band.endswith("Z")


def test_marks_outside_are_left_out() -> None:
    marks = [ChartMark(at, "alarm", "w", "#") for at in (-1.0, 50.0, 101.0)]
    none = np.zeros(0)
    drawn = chart("t", "", none, [Column("a", "gap", none, none, none)], WINDOW, marks=marks)
    assert [one.at for one in drawn.marks] == [50.0]
    assert drawn.words == "t, at the end: a –"
