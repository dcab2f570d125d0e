"""A record made by hand is a record, or is refused where it is made."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import polars as pl
import pytest

import rga
from rga.errors import InputError
from rga.given import as_record
from rga.model import read_model
from rga.records import Record

NAN, INF = float("nan"), float("inf")


def made(**changed: Any) -> Record:
    """A record of four rows of two sensors and a context, one part changed."""
    given: dict[str, Any] = {
        "time": np.arange(4.0),
        "readings": np.zeros((4, 2)),
        "contexts": {"snow": np.zeros(4)},
    }
    return Record(start=0.0, time_format="seconds", sensors=("A", "B"), **(given | changed))


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"time": np.array([0.0, 1.0, NAN, 3.0])}, "do not rise"),
        ({"time": np.full(4, NAN)}, "do not rise"),
        ({"time": np.array([-INF, 1.0, 2.0, 3.0])}, "do not rise"),
        ({"time": np.array([0.0, 1.0, 2.0, INF])}, "do not rise"),
        ({"time": np.array([0.0, 1.0, 1.0, 2.0])}, "do not rise"),
        ({"time": np.arange(4.0)[::-1]}, "do not rise"),
        ({"time": np.arange(4.0)[:, None]}, r"\(4, 1\) instead of \(4,\) .time of"),
        ({"time": 1.0, "readings": np.zeros(2), "contexts": {}}, "time of the record"),
        ({"time": np.arange(4).astype("M8[s]")}, "no plain numbers .time of the record"),
        ({"time": [[0.0], [1.0, 2.0]]}, "no plain numbers .time of the record"),
        ({"time": None}, "time of the record"),
        ({"readings": np.zeros((3, 2))}, r"\(3, 2\) instead of \(4, 2\) .readings of"),
        ({"readings": np.zeros((4, 1))}, r"\(4, 1\) instead of \(4, 2\)"),
        ({"readings": np.zeros(4)}, r"\(4,\) instead of \(4, 2\)"),
        ({"readings": np.zeros((4, 2), dtype=object)}, "no plain numbers .readings of"),
        ({"readings": np.zeros((4, 2), dtype=complex)}, "no plain numbers"),
        ({"readings": np.zeros((4, 2), dtype=bool)}, "no plain numbers"),
        ({"readings": [[1.0], [1.0, 2.0]]}, "no plain numbers"),
        ({"readings": np.ma.masked_less(np.zeros((4, 2)), 1.0)}, "no plain numbers"),
        ({"contexts": {"snow": "abcd"}}, "no plain numbers .context 'snow' of"),
        ({"contexts": {"snow": ["1", "2", "3", "4"]}}, "no plain numbers"),
        ({"contexts": {"snow": np.zeros(3)}}, r"\(3,\) instead of \(4,\) .context 'snow' of"),
        ({"contexts": {"snow": 1.0}}, r"\(\) instead of \(4,\)"),
        ({"contexts": ["snow"]}, "a list holds no contexts"),
        ({"contexts": None}, "None holds no contexts"),
    ],
)
def test_what_is_no_record_is_refused(changed: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        made(**changed)
    with pytest.raises(InputError, match=words):
        replace(made(), **changed)


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"readings": np.full((4, 2), NAN)},
        {"contexts": {}},
        {"contexts": {"snow": np.full(4, NAN)}},
        {"time": np.zeros(0), "readings": np.zeros((0, 2)), "contexts": {}},
        {"time": np.arange(4), "readings": np.zeros((4, 2), dtype=np.float32)},
        {"time": [0, 1, 2, 3], "contexts": {"snow": pl.Series([1.0, None, 2.0, 3.0])}},
    ],
)
def test_what_is_one_holds_floats(changed: dict[str, Any]) -> None:
    record = made(**changed)
    for held in (record.time, record.readings, *record.contexts.values()):
        assert held.dtype == np.float64
    assert record.readings.shape == (len(record), 2)


@pytest.mark.parametrize("value", [INF, -INF, 1e31, 1e29])
def test_what_nothing_measures_is_refused_before_work(
    value: float, measured_bridge: dict[str, Any], measured_record: Callable[..., Record]
) -> None:
    model = read_model(measured_bridge, "bridge")
    record = measured_record(model)
    record.readings[3, 0] = value
    if value == 1e29:
        assert as_record(record, model) is record
    else:
        with pytest.raises(InputError, match="in row 3"):
            rga.diagnose(model, record)


def test_nothing_is_copied() -> None:
    """Records of a million rows are cut again and again."""
    record = made()
    readings = record.readings
    assert replace(record, sha256="other").readings is readings
    assert np.shares_memory(record.rows(slice(1, 3)).readings, readings)
