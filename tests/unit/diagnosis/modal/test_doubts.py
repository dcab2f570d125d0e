"""What is odd in a modal record is told, and of a sound one nothing."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from independent.modal_bridge import Hidden, measured
from rga.diagnosis.modal.doubts import odd_entries, weather
from rga.model.schema import ContextVariable


def test_of_a_sound_record_nothing_is_said() -> None:
    model, record = measured(1, Hidden(), windows=5)
    assert odd_entries(model, replace(record, duration=np.full(len(record), 600.0))) == []


def test_what_can_hardly_be_meant_is_told() -> None:
    model, record = measured(1, Hidden(), windows=5)
    air = ContextVariable(unit="degC", range=(-20.0, 40.0))
    model = model.model_copy(update={"context": {"air": air}})
    again = record.entries(np.ones(len(record), dtype=bool))
    time, frequency, shapes = again.time.copy(), again.frequency.copy(), again.shapes.copy()
    time[1], frequency[1], shapes[1] = time[0], frequency[0], shapes[0]
    kelvin = np.where(record.windows < 2, 290.0, 10.0)
    odd = replace(
        again, time=time, frequency=frequency, shapes=shapes, duration=np.full(len(time), 1e9),
        contexts={"air": kelvin},
    )  # fmt: skip
    twice, long, far = odd_entries(model, odd)
    assert twice == "1 entry stands in the record more than once: each counts once"
    assert "days: what changes within one shows as its mean alone" in long
    assert far == "air lies outside its range -20..40 in 2 windows: check its unit and its zero"


def test_shapes_of_a_single_point_are_told() -> None:
    model, record = measured(1, Hidden(), windows=5)
    shapes = record.shapes.copy()
    shapes[:2, 1:] = np.nan
    (words,) = odd_entries(model, replace(record, shapes=shapes))
    assert words == "2 entries have their shapes at a single point: by that all modes look alike"


@pytest.mark.parametrize(
    ("air", "doubted"),
    [(None, True), ([np.nan] * 4, True), ([5.0] * 4, True), ([1.0, np.nan, 3.0, 2.0], False)],
)
def test_a_small_late_change_may_be_the_weather_unless_that_was_measured(
    air: list[float] | None, doubted: bool
) -> None:
    readings: Any = SimpleNamespace(weather={} if air is None else {"air": np.array(air)})
    late: Any = SimpleNamespace(onset=3600.0)
    after: Any = SimpleNamespace(log_f=np.array([[0.0], [0.0], [0.01], [0.01]]))
    assert bool(weather(readings, [late], after)) is doubted
    assert not weather(readings, [], after)
