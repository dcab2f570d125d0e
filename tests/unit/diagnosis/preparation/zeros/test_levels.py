"""Levels of long records are those of short ones, worked out in parts."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.diagnosis.preparation.zeros.levels import Compared
from rga.diagnosis.preparation.zeros.restarted import jump_of_many
from rga.diagnosis.preparation.zeros.zero_rows import zero_rows
from rga.diagnosis.preparation.zeros.zeroed_again import zero_from
from rga.model import Model
from rga.simulation import Simulator

LEVELS = "rga.diagnosis.preparation.zeros.levels"


@pytest.fixture
def compared(model: Model, prepared: PreparedRecord) -> Compared:
    return Compared.of(model, Simulator(model), prepared.data)


@pytest.mark.parametrize("row", [5, 50, 85])
def test_causes_of_a_few_rows_change_what_those_of_all_do(
    row: int, compared: Compared, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = np.array(list(compared.changes_from(row, 10)))
    monkeypatch.setattr(f"{LEVELS}.MOST_ROWS", 30)
    assert len(compared.thinned().simulated) == 25
    found = np.array(list(compared.changes_from(row, 10)))
    assert np.abs(expected).max() > 1
    # Creep and lags remember rows before those that are looked at.
    alike = np.isclose(found, expected, rtol=1e-6, atol=1e-6).all(1)
    assert alike.mean() > 0.95


@pytest.mark.parametrize("look", [zero_from, jump_of_many, zero_rows])
@pytest.mark.parametrize("hidden", ["nothing", "a zero", "a jump"])
def test_what_is_found_in_blocks_is_found_at_once(
    look: Callable[[Compared], object],
    hidden: str,
    model: Model,
    compared: Compared,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    readings = compared.data.readings.copy()
    if hidden == "a zero":
        readings[40:] -= compared.simulated[40]
    if hidden == "a jump":
        readings[40:, ::2] += 60 * compared.noise[::2]
    data = replace(compared.data, readings=readings)
    given = Compared.of(model, compared.simulator, data)
    expected = look(given)
    monkeypatch.setattr(f"{LEVELS}.BLOCK", 7)
    assert repr(look(given)) == repr(expected)
    if hidden == "nothing":
        assert expected is None
    if (hidden, look) in (("a zero", zero_from), ("a jump", jump_of_many)):
        assert expected is not None
