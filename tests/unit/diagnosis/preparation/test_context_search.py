"""Contexts that nothing measured, sought before anything else is known."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rga.diagnosis.preparation.context_search import guess_lines, guess_rows
from rga.diagnosis.preparation.prepare import prepare
from rga.model import Model, read_model
from rga.records import Record
from rga.simulation import Simulator

ROWS = 30
TIME = 600.0 * np.arange(ROWS)


def record(model: Model, contexts: dict[str, np.ndarray], measured: list[str]) -> Record:
    readings = Simulator(model).predict({"time": TIME, **contexts})
    noise = np.array([sensor.noise for sensor in model.sensors.values()], dtype=float)
    readings += noise * np.random.default_rng(0).standard_normal(readings.shape)
    known = {name: contexts[name] for name in measured}
    return Record(TIME, 0.0, "seconds", tuple(model.sensors), readings, known)


@pytest.fixture
def contexts() -> dict[str, np.ndarray]:
    draw = np.random.default_rng(4)
    return {
        "temperature": np.full(ROWS, 12.0),
        "west load": 20 + 60 * draw.random(ROWS),
        "east load": 20 + 60 * draw.random(ROWS),
    }


def nothing(done: float) -> None:
    pass


def test_loads_of_each_row_are_read_from_the_row(
    small_bridge: dict[str, Any], contexts: dict[str, np.ndarray]
) -> None:
    model = read_model(small_bridge, "small bridge")
    data = prepare(model, record(model, contexts, ["temperature"]), nothing).data
    middle = {name: np.full(ROWS, 50.0) for name in ("west load", "east load")}
    blind = replace(data, belief=data.belief.with_values(middle))
    found = guess_rows(Simulator(model), blind).belief
    for name in middle:
        np.testing.assert_allclose(found.table[name], contexts[name], atol=3.0)
        np.testing.assert_array_equal(found.centre[name], found.table[name])
    np.testing.assert_array_equal(found.table["temperature"], data.belief.table["temperature"])


def test_measured_contexts_are_left_as_they_are(
    measured_bridge: dict[str, Any], contexts: dict[str, np.ndarray]
) -> None:
    model = read_model(measured_bridge, "small bridge")
    data = prepare(model, record(model, contexts, list(contexts)), nothing).data
    assert guess_rows(Simulator(model), data) is data
    assert guess_lines(Simulator(model), data, nothing) is data


def test_a_line_is_found_whatever_the_gains_are(
    small_bridge: dict[str, Any], contexts: dict[str, np.ndarray]
) -> None:
    context = dict(small_bridge["context"])
    context["west load"] = {**context["west load"], "law": "linear", "rate": [-0.01, 0.01]}
    model = read_model({**small_bridge, "context": context}, "small bridge")
    line = 30.0 + 0.002 * TIME
    one = record(
        model,
        {**contexts, "west load": line, "east load": np.zeros(ROWS)},
        ["temperature", "east load"],
    )
    data = prepare(model, replace(one, readings=1.1 * one.readings), nothing).data
    found = guess_lines(Simulator(model), data, nothing).belief.table["west load"]
    start, end = found[0] / found.mean(), found[-1] / found.mean()
    assert start == pytest.approx(line[0] / line.mean(), abs=0.1)
    assert end == pytest.approx(line[-1] / line.mean(), abs=0.1)


def test_a_truck_far_from_midspan_is_found_in_each_row(
    small_bridge: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Steps from the middle of its path end there: what moves to either side reads less."""
    truck = {
        "kind": "axle_load",
        "path": [f"L{number}" for number in range(5)],
        "forces": [30e3],
        "offsets": [0.0],
        "position": {"context": "truck"},
    }
    content = {
        **small_bridge,
        "context": {
            "temperature": small_bridge["context"]["temperature"],
            "truck": {"unit": "m", "range": [0, 12]},
        },
        "effects": {"warmth": small_bridge["effects"]["warmth"], "truck": truck},
    }
    model = read_model(content, "small bridge")
    place = np.tile([2.0, 4.5, 7.0, 10.5, 11.0, 1.0], 5)
    truth = {"temperature": np.full(ROWS, 12.0), "truck": place}
    data = prepare(model, record(model, truth, ["temperature"]), nothing).data
    blind = replace(data, belief=data.belief.with_values({"truck": np.full(ROWS, 6.0)}))
    monkeypatch.setattr("rga.diagnosis.preparation.context_search.TRIALS", 32)
    found = guess_rows(Simulator(model), blind).belief.table["truck"]
    np.testing.assert_allclose(found, place, atol=0.5)
