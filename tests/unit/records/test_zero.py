"""The span whose mean a logger took off: within the record, or refused."""

from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model, read_model
from rga.records import Record
from rga.records.zero import zeros_of


def zeroed(two_bars: dict[str, Any], zero: list[float | str]) -> Model:
    sensors = dict(two_bars["sensors"])
    sensors["D1"] = {**sensors["D1"], "zero": zero}
    return read_model({**two_bars, "sensors": sensors}, "test")


def record(*sensors: str) -> Record:
    return Record(np.arange(4.0), 10.0, "seconds", sensors, np.zeros((4, len(sensors))))


@pytest.mark.parametrize("zero", [[10.0, 11.0], [0.0, 10.5], [13.0, 90.0], [11.0, 11.0]])
def test_a_span_that_meets_the_record_counts_from_its_first_row(
    two_bars: dict[str, Any], zero: list[float | str]
) -> None:
    found = zeros_of(zeroed(two_bars, zero), record("D1", "S1"))
    assert found == [(float(zero[0]) - 10, float(zero[1]) - 10), None]


@pytest.mark.parametrize("zero", [[0.0, 9.0], [14.0, 20.0], ["2024-01-01", "2024-01-02"]])
def test_a_span_outside_the_record_is_refused(
    two_bars: dict[str, Any], zero: list[float | str]
) -> None:
    model = zeroed(two_bars, zero)
    with pytest.raises(InputError, match=r"outside the record, 10\.0 to 13\.0 \(sensor 'D1'"):
        zeros_of(model, record("D1", "S1"))
    assert zeros_of(model, record("S1"))[1] is None


def test_a_span_that_runs_backwards_is_refused(two_bars: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"sensors\.D1\.zero: .*run backwards"):
        zeroed(two_bars, [12.0, 11.0])
