"""From a record to data: rows, channels and warnings."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.preparation.prepare import PreparedRecord, prepare
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.simulation import Simulator


@pytest.fixture
def record(model: Model, measured_record: Callable[..., Record]) -> Record:
    return measured_record(model)


def ready(model: Model, record: Record) -> PreparedRecord:
    return prepare(model, record, lambda done: None)


def test_a_sound_record_is_taken_whole(model: Model, record: Record) -> None:
    found = ready(model, record)
    assert found.data.sensors == record.sensors
    np.testing.assert_array_equal(found.data.readings, record.readings)
    assert found.chosen.all()
    assert (found.faults, found.warnings, found.apart) == ([], [], ())


def test_of_many_candidates_fewer_rows_are_analysed(
    model: Model, record: Record, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.diagnosis.preparation.prepare.MOST_VALUES", 1)
    found = ready(model, record)
    # No fewer than the criterion of few rows, 60 of 100.
    assert np.flatnonzero(found.chosen).tolist() == list(range(0, 100, 2))
    assert len(found.data.time) == 50
    (said,) = [one for one in found.warnings if "possible causes leave no room for more" in one]
    assert said.startswith("of 100 rows at most 60, evenly chosen, were analysed: ")


def test_missing_readings_and_contexts_are_left_aside(model: Model, record: Record) -> None:
    readings, warmth = record.readings.copy(), record.contexts["temperature"].copy()
    readings[3, 2] = warmth[[7, 8]] = np.nan
    contexts = {**record.contexts, "temperature": warmth}
    found = ready(model, replace(record, readings=readings, contexts=contexts))
    observed = found.data.observed
    assert not observed[3, 2]
    assert not observed[[7, 8]].any()
    assert observed.sum() == observed.size - 1 - 2 * observed.shape[1]
    assert "2 rows without a context" in " ".join(found.warnings)


def test_channels_that_do_not_work_are_rejected(model: Model, record: Record) -> None:
    readings = record.readings.copy()
    readings[:, 0] = 1.25
    found = ready(model, replace(record, readings=readings))
    assert [(one.sensor, one.mode) for one in found.faults] == [("D1", "stuck")]
    assert "D1" not in found.data.sensors
    assert found.data.readings.shape[1] == len(record.sensors) - 1
    with pytest.raises(InputError, match="none of the channels works"):
        ready(model, replace(record, readings=np.ones_like(readings)))


def test_a_channel_can_be_left_out_later(model: Model, record: Record) -> None:
    found = ready(model, record).leaving_out("D2", Simulator(model))
    assert found.apart == ("D2",)
    assert "D2" not in found.data.sensors
    assert found.faults == []


def test_readings_in_another_unit_are_a_warning(model: Model, record: Record) -> None:
    found = ready(model, replace(record, readings=1000 * record.readings))
    assert "about 1000 times as large" in " ".join(found.warnings)


def test_a_context_that_stands_still_or_is_out_of_range_is_a_warning(
    model: Model, record: Record
) -> None:
    still = record.contexts["temperature"].copy()
    still[-30:] = still[-30]
    contexts = {**record.contexts, "temperature": still}
    warnings = " ".join(ready(model, replace(record, contexts=contexts)).warnings)
    assert "temperature reads" in warnings
    assert "in the last 30 of 100 rows" in warnings
    kelvin = {**record.contexts, "temperature": record.contexts["temperature"] + 273.15}
    warnings = " ".join(ready(model, replace(record, contexts=kelvin)).warnings)
    assert "temperature lies outside its range -20..40 in every row" in warnings


def test_few_rows_are_a_warning_and_fewer_are_refused(model: Model, record: Record) -> None:
    few = np.arange(len(record)) < 40
    assert "only 40 rows" in ready(model, record.rows(few)).warnings[0]
    with pytest.raises(InputError, match="the record has 5 rows"):
        ready(model, record.rows(np.arange(len(record)) < 5))


def test_a_context_of_one_value_is_a_warning(model: Model, record: Record) -> None:
    contexts = {**record.contexts, "temperature": np.full(len(record), 20.0)}
    warnings = ready(model, replace(record, contexts=contexts)).warnings
    (words,) = (one for one in warnings if "temperature" in one)
    assert words == (
        "temperature has one value, 20, in all rows: what it does cannot be seen, and if it was "
        "not measured leave it out of the record, so that it is inferred"
    )


@pytest.mark.parametrize(
    ("channels", "words"),
    [
        ([0], "a lone spike of D1 was taken as a missing reading"),
        ([0, 1], "2 lone spikes of D1, D2 were taken as missing readings"),
    ],
)
def test_lone_spikes_are_counted(
    model: Model, record: Record, channels: list[int], words: str
) -> None:
    readings = record.readings.copy()
    readings[40, channels] += 1000 * (model.sensors["D1"].noise or 0.0)
    assert ready(model, replace(record, readings=readings)).warnings == [words]
