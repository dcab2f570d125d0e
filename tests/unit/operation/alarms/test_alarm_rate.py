"""The sentence of an alarm claims no rate that its calibration cannot support."""

from typing import Any

import pytest

from rga.model import read_model
from rga.operation.alarms.alarm_rate import rate_words
from rga.twin.settings import Settings

#: rows of half an hour that three days have
THREE_DAYS = 144


def settings(rows: int, **more: Any) -> Settings:
    return Settings(calibration_rows=rows, packet=6, settle=12, **more)


def test_a_short_calibration_supports_no_rate(measured_bridge: dict[str, Any]) -> None:
    model = read_model(measured_bridge, "bridge")
    said = rate_words(settings(120), 1800.0, model)
    assert "without a change is not known: the calibration took 2.5 days" in said
    assert "10000" not in said


@pytest.mark.parametrize("rows", [THREE_DAYS, 10 * THREE_DAYS])
def test_a_long_calibration_supports_it(rows: int, measured_bridge: dict[str, Any]) -> None:
    said = rate_words(settings(rows), 1800.0, read_model(measured_bridge, "bridge"))
    assert said.endswith("such an alarm comes once in 10000 rows (208 days) on average")


def test_without_contexts_no_day_brings_what_is_new(bars: dict[str, Any]) -> None:
    model = read_model({**bars, "context": {}, "effects": {}}, "bars")
    assert not model.context
    assert "once in 10000 rows" in rate_words(settings(10), 1800.0, model)


def test_of_the_rule_of_the_paper_nothing_is_known(measured_bridge: dict[str, Any]) -> None:
    model = read_model(measured_bridge, "bridge")
    assert rate_words(settings(THREE_DAYS, detector="window"), 1800.0, model) == ""
