"""Sensors that say nothing, or nothing that can be: told of, and of nothing else."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rga.model import Model, read_model
from rga.operation.alarms.sensor_quality import SensorQuality
from rga.operation.inbox.kept_cells import KeptCell
from rga.operation.service_clock import moment_of

EVERY, PATIENCE = 600.0, 1800.0
NAMES = ("D1", "D2", "temperature")
#: rows of ten days
ROWS = 1440
#: rows that are known before a sensor can be stuck, and one more
DAY = 145


@pytest.fixture(scope="module")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "measured bridge")


Spoil = Callable[[int, dict[str, np.ndarray[Any, Any]]], None]


def cells(spoil: Spoil, rows: int = ROWS, seed: int = 3) -> list[KeptCell]:
    """Cells of sound sensors, of which a test spoils some."""
    draw = np.random.default_rng(seed)
    found = []
    for k in range(rows):
        mean = draw.normal(size=len(NAMES))
        mean[2] += 15 + 5 * np.sin(2 * np.pi * k / 144)
        values = {
            "count": np.full(len(NAMES), 5, np.uint32),
            "least": (mean - 0.1).astype(np.float32),
            "most": (mean + 0.1).astype(np.float32),
            "conflicts": np.zeros(len(NAMES), np.uint32),
        }
        spoil(k, values)
        found.append(KeptCell(begin=k * round(EVERY * 1e6), **values))
    return found


def fresh(model: Model, state: str | None = None) -> SensorQuality:
    return SensorQuality("east", NAMES, model, EVERY, PATIENCE, state)


def told(model: Model, spoil: Spoil, **more: Any) -> list[tuple[int, str, str]]:
    """Row, cause and sensor of all that is told of for the first time."""
    quality, known, found = fresh(model), set(), []
    for row, cell in enumerate(cells(spoil, **more)):
        quality.take(cell)
        now = {(one.key.cause, one.key.subject) for one in quality.conditions()}
        found += [(row, *one) for one in sorted(now - known)]
        known = now
    return found


@pytest.mark.parametrize(
    ("spoil", "cause", "words", "row"),
    [
        ("stuck", "stuck", "D2 has stood still at 0.5 m", 201),
        ("outside", "out of range", "temperature reads 1e+06 degC, which its range of ", 100),
        ("silent", "silent", "D2 sends nothing", 100),
    ],
)
def test_an_alarm_says_the_value_and_since_when(
    model: Model, spoil: str, cause: str, words: str, row: int
) -> None:
    quality, said = fresh(model), set()
    for cell in cells(globals()[spoil], rows=600):
        quality.take(cell)
        for one in quality.conditions():
            assert one.key.cause == cause
            said.add((one.words, one.since))
        # What is known after a restart says the same.
        again = fresh(model, quality.to_json())
        assert again.conditions() == quality.conditions()
    ((words_said, since),) = said
    assert words_said.startswith(words)
    assert since == moment_of(row * round(EVERY * 1e6))
    if cause == "out of range":
        low, high = model.context["temperature"].range
        assert words_said == f"{words}{low:g} to {high:g} degC does not hold"


def nothing(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
    """Nothing is wrong."""


def rounded(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
    """A slow sensor of few digits, which stands still for an hour or two and more."""
    values["least"][0] = values["most"][0] = np.round(2 * np.sin(2 * np.pi * row / 144))


def silent(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
    if 100 <= row < 110:
        values["count"][1] = 0
        values["least"][1] = values["most"][1] = np.nan


def stuck(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
    if row >= 200:
        values["least"][1] = values["most"][1] = 0.5


def outside(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
    if row in (50, 60, 61) or row >= 100:
        values["most"][2] = 1e6


def conflicting(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
    if row == 50 or row >= 100:
        values["conflicts"][0] = 2


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("spoil", [nothing, rounded])
def test_of_sound_sensors_nothing_is_told(model: Model, spoil: Spoil, seed: int) -> None:
    assert told(model, spoil, seed=seed) == []


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (silent, [(102, "silent", "D2")]),
        (stuck, [(230, "stuck", "D2")]),
        (outside, [(102, "out of range", "temperature")]),
        (conflicting, [(102, "conflict", "D1")]),
    ],
)
def test_what_is_wrong_is_told_once(
    model: Model, spoil: Spoil, expected: list[tuple[int, str, str]]
) -> None:
    assert told(model, spoil, rows=400) == expected


def test_a_condition_says_since_when_and_which(model: Model) -> None:
    quality = fresh(model)
    for cell in cells(silent, rows=105):
        quality.take(cell)
    (found,) = quality.conditions()
    assert found.words == "D2 sends nothing"
    assert found.sensors == ("D2",)
    assert found.since.timestamp() == 100 * EVERY


def test_a_sensor_that_never_sent_is_silent(model: Model) -> None:
    def never(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
        values["count"][0] = 0
        values["least"][0] = values["most"][0] = np.nan

    assert told(model, never, rows=200) == [(2, "silent", "D1")]


def test_nothing_is_stuck_before_a_night_and_a_day(model: Model) -> None:
    def still(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
        values["least"][1] = values["most"][1] = 0.5

    assert told(model, still, rows=400) == [(DAY - 1, "stuck", "D2")]


def test_a_context_may_stand_still_unless_its_noise_is_known(
    model: Model, bars: dict[str, Any]
) -> None:
    def calm(row: int, values: dict[str, np.ndarray[Any, Any]]) -> None:
        values["least"][2] = values["most"][2] = 15.0

    assert told(read_model(bars, "bars"), calm) == []
    assert told(model, calm) == [(DAY - 1, "stuck", "temperature")]


@pytest.mark.parametrize("spoil", [nothing, silent, stuck, outside, conflicting])
def test_it_goes_on_where_it_was(model: Model, spoil: Spoil) -> None:
    whole, cut = fresh(model), fresh(model)
    for row, cell in enumerate(cells(spoil, rows=300)):
        whole.take(cell)
        cut.take(cell)
        if row % 37 == 0:
            cut = fresh(model, cut.to_json())
    assert cut.conditions() == whole.conditions()
    assert cut.to_json() == whole.to_json()
    assert cut.last == whole.last
