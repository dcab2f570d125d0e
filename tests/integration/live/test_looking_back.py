"""Effects that look back in a twin: rows in packets read what all rows together do."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, assert_same, history, pieces
from rga.errors import InputError
from rga.model import Model, read_effect
from rga.records import Record
from rga.simulation import Simulator
from rga.twin.calibration.memories import ANEW, MARKS, Mark, Memories

LOOKING_BACK: dict[str, dict[str, Any]] = {
    "lag": {"kind": "thermal_lag", "time_constant": 3.0},
    "drift": {"kind": "sensor_drift", "sensor": "D2", "rate": 0.5},
    "stuck": {
        "kind": "bearing_friction",
        "support": "east",
        "dof": "ux",
        "mu": 0.1,
        "permanent_force": 2e4,
    },
}


def looking_back(model: Model, *names: str) -> Model:
    own = {name: read_effect(LOOKING_BACK[name], name) for name in names}
    return model.extended(own)


@pytest.mark.parametrize("names", [("lag",), ("drift",), ("stuck",), tuple(LOOKING_BACK)])
def test_packets_read_what_all_rows_together_do(
    names: tuple[str, ...], sound: tuple[Model, Record], tmp_path: Path
) -> None:
    model, record = looking_back(sound[0], *names), sound[1]
    expected = Simulator(model).predict({"time": record.time, **record.contexts})
    plain = Simulator(sound[0]).predict({"time": record.time, **record.contexts})
    assert np.abs(expected - plain).max() > 0.01, "the effect is a part of the test"
    # The record is without the effect: a twin that watched would change.
    settings, found = SETTINGS.model_copy(update={"level": "A"}), []
    for number, cuts in enumerate(([], [3, 41, 77])):
        with rga.live(model, tmp_path / str(number), settings=settings) as twin:
            for piece in pieces(record, cuts):
                twin.feed(piece)
                twin.play()
                twin.close()
            found.append(history(twin))
    assert_same(*found)
    largest = np.abs(expected).max()
    np.testing.assert_allclose(found[0].simulated, expected, rtol=0, atol=1e-12 * largest)


def test_what_cannot_be_followed_is_refused(sound: tuple[Model, Record], tmp_path: Path) -> None:
    ramp = {**LOOKING_BACK["drift"], "profile": "ramp", "onset": 600.0}
    endless = sound[0].extended({"slow": read_effect(ramp, "slow")})
    with pytest.raises(InputError, match="ramp"):
        rga.live(endless, tmp_path, settings=SETTINGS)


def test_rows_are_followed_again_from_what_was_kept_before_them() -> None:
    memories = Memories()
    kept = [rga.simulation.Memory({"creep": {"first": np.array([float(row)])}}) for row in range(3)]
    assert memories.before(50, 1, "") == (0, None)
    memories.keep(0, Mark(20, 1, "", kept[0]))
    memories.keep(20, Mark(40, 1, "", kept[1]))
    assert memories.before(50, 1, "") == (40, kept[1])
    assert memories.before(39, 1, "") == (20, kept[0])
    # Another version of the model looks back at all rows, another structure at some of them.
    assert memories.before(50, 2, "") == (0, None)
    assert memories.before(50, 1, "found") == (0, None)
    row, memory = memories.before(ANEW + 30, 1, "found")
    assert row == 20
    assert memory is not None
    assert memory.effects == kept[0].effects
    # What was followed again replaces what stood for the rows from there on.
    memories.keep(20, Mark(60, 1, "found", kept[2]))
    assert memories.before(50, 1, "") == (20, kept[0])
    again = Memories()
    again.restore(memories.to_bytes())
    assert again.to_bytes() == memories.to_bytes()


def test_few_of_many_marks_are_kept() -> None:
    memories = Memories()
    for row in range(10, 5000, 10):
        memories.keep(row - 10, Mark(row, 1, "", rga.simulation.Memory()))
    assert memories.before(10_000, 1, "")[0] == 4990
    assert memories.before(4985, 1, "")[0] == 4980
    assert len(memories.to_bytes()) < 50 * MARKS
