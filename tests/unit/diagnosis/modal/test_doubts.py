"""What is odd in a modal record is told, and of a sound one nothing."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from independent.accelerometers import scaled
from independent.modal_bridge import Hidden, measured
from rga.arrays import FloatArray
from rga.diagnosis.modal.checks import pairs_in_doubt
from rga.diagnosis.modal.doubts import (
    following_contexts,
    lagging,
    odd_entries,
    thin,
    unlike_modes,
    warnings_of,
    weather,
)
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.model import Model
from rga.model.schema import ContextVariable
from rga.records.modal.record import ModalRecord

AIR = ContextVariable(unit="degC", range=(-20.0, 40.0))


def test_of_a_sound_record_nothing_is_said() -> None:
    model, record = measured(1, Hidden(), windows=5)
    assert odd_entries(model, replace(record, duration=np.full(len(record), 600.0))) == []


def test_what_can_hardly_be_meant_is_told() -> None:
    model, record = measured(1, Hidden(), windows=5)
    model = model.model_copy(update={"context": {"air": AIR}})
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


@pytest.mark.parametrize("years", [2, 20])
def test_years_without_a_window_are_told(years: int) -> None:
    model, record = measured(1, Hidden(), windows=10)
    late = record.windows >= 5
    apart = replace(record, time=record.time + late * years * 365 * 86_400.0)
    told = odd_entries(model, apart)
    assert [one.startswith("nothing was measured for 7300 days") for one in told] == [True] * (
        years > 3
    )


def test_shapes_of_a_single_point_are_told() -> None:
    model, record = measured(1, Hidden(), windows=5)
    shapes = record.shapes.copy()
    shapes[:2, 1:] = np.nan
    (words,) = odd_entries(model, replace(record, shapes=shapes))
    assert words == "2 entries have their shapes at a single point: by that all modes look alike"


@pytest.mark.parametrize(
    ("air", "told"),
    [
        (None, "no temperature stands beside the frequencies"),
        ([np.nan] * 4, "no temperature stands beside the frequencies"),
        ([5.0] * 4, "air never changes beside the frequencies"),
        ([1.0, np.nan, 3.0, 2.0], None),
    ],
)
def test_a_small_late_change_may_be_the_weather_unless_that_was_measured(
    air: list[float] | None, told: str | None
) -> None:
    readings: Any = SimpleNamespace(weather={} if air is None else {"air": np.array(air)})
    late: Any = SimpleNamespace(onset=3600.0)
    after: Any = SimpleNamespace(log_f=np.array([[0.0], [0.0], [0.01], [0.01]]))
    doubts = weather(readings, [late], after)
    assert [told is not None and told in one for one in doubts] == [True] * (told is not None)
    assert not weather(readings, [], after)


@pytest.mark.parametrize("windows", [5, 12])
def test_a_column_that_never_changes_is_told(windows: int) -> None:
    """Of few windows it may well be as warm in all of them."""
    model, record = measured(1, Hidden(), windows=windows)
    stuck = replace(record, contexts={"air": np.full(len(record), 5.0)})
    model = model.model_copy(update={"context": {"air": AIR}})
    told = [one for one in warnings_of(model, ModalReadings.of(model, stuck)) if "air" in one]
    words = "air is 5 in every window: a column that never changes tells nothing"
    assert [one.startswith(words) for one in told] == [True] * (windows > 5)


def test_modes_that_are_few_are_named() -> None:
    readings: Any = SimpleNamespace(modes=("m1",), looks=[SimpleNamespace(at=[0])])
    assert thin(readings, causes=True) == [
        "of the modes expected m1 alone was found, and 3 are needed to decide"
    ]


def test_pairs_that_are_in_doubt_are_named() -> None:
    likelihood: Any = SimpleNamespace(readings=SimpleNamespace(modes=("m1", "m2")))
    prediction: Any = SimpleNamespace(doubtful=frozenset({(1, 6, 7)}))
    (words,) = pairs_in_doubt(likelihood, prediction)
    assert words.endswith("nearly as probable: m2 may be mode 8 of the model in place of 7")
    prediction.doubtful = frozenset()
    assert pairs_in_doubt(likelihood, prediction) == []


def warm(windows: int) -> FloatArray:
    """Days of the air [degC]."""
    return np.asarray(5.0 + 8.0 * np.sin(np.arange(windows) / 4.0))


def following(share: float, lag: int, windows: int = 60) -> tuple[Model, ModalRecord]:
    """A bridge whose frequencies follow the air of some windows before, over its range."""
    model, record = measured(1, Hidden(), windows=windows)
    model = model.model_copy(update={"context": {"air": AIR}})
    air = warm(windows)
    before = 5.0 + 8.0 * np.sin((np.arange(windows) - lag) / 4.0)
    factor = np.exp(-share * (before - air.mean()) / np.ptp(air))
    air_of = air[record.windows]
    return model, replace(
        record, frequency=record.frequency * factor[record.windows], contexts={"air": air_of}
    )


@pytest.mark.parametrize("share", [0.0, 0.02, 0.06])
def test_more_of_the_weather_than_is_usual_is_told(share: float) -> None:
    model, record = following(share, 0)
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    told = following_contexts(likelihood, likelihood.trials.predict({}))
    assert [one.startswith("frequencies follow air by up to") for one in told] == [True] * (
        share > 0.03
    )


@pytest.mark.parametrize("lag", [0, 3])
def test_weather_that_lags_is_told_where_something_begins_late(lag: int) -> None:
    model, record = following(0.02, lag)
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    nothing = likelihood.trials.predict({})
    late: Any = SimpleNamespace(onset=3600.0)
    always: Any = SimpleNamespace(onset=None)
    told = lagging(likelihood, [late], nothing)
    assert [one.split(" before")[0] for one in told] == ["air of 3 windows"] * (lag > 0)
    assert lagging(likelihood, [always], nothing) == []


def test_few_windows_say_nothing_of_a_lag() -> None:
    model, record = following(0.02, 3, windows=10)
    likelihood = ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))
    late: Any = SimpleNamespace(onset=3600.0)
    assert lagging(likelihood, [late], likelihood.trials.predict({})) == []


@pytest.mark.parametrize("points", [0, 12])
def test_what_swings_otherwise_where_modes_are_expected_is_told(points: int) -> None:
    """So many points are turned from the middle on: of one or two a mode keeps its name."""
    model, record = measured(1, Hidden())
    other = scaled(record, dict.fromkeys(list(model.points)[:points], -1.0))
    late = (record.windows >= 20)[:, None]
    mixed = replace(record, shapes=np.where(late, other.shapes, record.shapes))
    told = unlike_modes(ModalReadings.of(model, mixed))
    assert len(told) == (points > 2)
    assert all("something swings in another shape" in one for one in told)


@pytest.mark.parametrize("moved", [0.0, 0.26])
def test_a_mode_that_is_lacking_and_what_swings_elsewhere_may_be_one(moved: float) -> None:
    model, record = measured(1, Hidden())
    own = ModalReadings.of(model, record)
    of_mode = own.entries == own.modes.index("m5")
    away = np.where(of_mode, np.log1p(-moved), 0.0)
    turned = np.where(of_mode[:, None], np.roll(record.shapes, 1, axis=1), record.shapes)
    other = replace(
        record,
        frequency=record.frequency * np.exp(away),
        shapes=turned if moved else record.shapes,
    )
    told = unlike_modes(ModalReadings.of(model, other))
    assert len(told) == (moved > 0)
    assert all("1 mode (m5) is hardly ever found" in one for one in told)


@pytest.mark.parametrize("repeats", [False, True])
def test_windows_that_are_all_alike_are_told(repeats: bool) -> None:
    model, record = measured(1, Hidden())
    if repeats:
        own = ModalReadings.of(model, record)
        first = np.exp(np.nanmedian(own.log_f, axis=0))
        known = own.entries >= 0
        alike = np.where(known, first[own.entries], record.frequency)
        record = replace(record, frequency=alike)
    told = warnings_of(model, ModalReadings.of(model, record))
    assert any("hardly differ from one window to the next" in one for one in told) == repeats
