"""Sensors as the tables of the pages say them."""

from math import nan
from typing import Any

from rga.dashboard.pages.sensors_now import farthest_first, out_of_use_words, sensor_rows
from rga.model import read_model
from rga.operation.reading.twin_now import SensorNow, TwinNow


class Shown:
    """Where a twin stands, as far as a table of sensors looks at it."""

    def __init__(self, gaps: dict[str, float | None], out_of_use: tuple[str, ...] = ()) -> None:
        self.sensors = {name: sensor(gap) for name, gap in gaps.items()}
        self.out_of_use = out_of_use


def sensor(gap: float | None) -> SensorNow:
    return SensorNow(measured=1e-3, simulated=2e-3, noise=1e-4, gap=gap, recent=gap)


def test_the_largest_gap_comes_first_and_what_is_not_known_last(
    measured_bridge: dict[str, Any],
) -> None:
    model = read_model(measured_bridge, "bridge")
    gaps = [2.1, None, 4.9, 3.0, 150.0, nan, 0.4]
    names = list(model.sensors)[: len(gaps)]
    now: TwinNow = Shown(dict(zip(names, gaps, strict=True)))  # type: ignore[assignment]
    assert out_of_use_words(now) == ""
    found = farthest_first(sensor_rows(model, now))
    assert [one.name for one in found] == [names[place] for place in (4, 2, 3, 0, 6, 1, 5)]
    assert [one.gap for one in found][-2:] == ["–", "–"]


def test_a_sensor_that_is_out_of_use_is_said_to_be_so(measured_bridge: dict[str, Any]) -> None:
    model = read_model(measured_bridge, "bridge")
    one, other = list(model.sensors)[:2]
    now: TwinNow = Shown({one: 150.0, other: 1.0}, (one,))  # type: ignore[assignment]
    found = farthest_first(sensor_rows(model, now))
    assert [(row.name, row.level.words) for row in found] == [
        (other, "as noise"),
        (one, "out of use"),
    ]
    assert "out of use" in found[1].words
    assert out_of_use_words(now) == "1 of 2 sensors is out of use"
