"""What else may go wrong while a service runs: its own clock is set, a diagnosis fails."""

from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import history, sinking
from rga.errors import InputError
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.served_twin import ServedTwin
from rga.records import Record
from rga.twin import runner
from served.bridges import packets_of
from served.made_service import write_service
from served.service_times import NOON, SetClock

ROWS, FEW = 200, 30
HTTP = 'kind = "http"'


@pytest.mark.parametrize("jump", [timedelta(hours=5), timedelta(minutes=-20)])
def test_a_clock_of_the_service_that_is_set_changes_no_row(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path: Path,
    jump: timedelta,
) -> None:
    write_service(tmp_path, measured_bridge, source=HTTP)
    (settings,) = read_configuration(tmp_path / "serve.toml").twin
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, FEW)
    rows = []
    for place, by in (("calm", timedelta(0)), ("set", jump)):
        clock = SetClock()
        twin = ServedTwin(settings, tmp_path / place, clock)
        for number, packet in enumerate(packets_of(record, NOON)):
            assert twin.receive("http", [("http", packet)]) == [("waiting", None)]
            clock.pass_by(600)
            twin.seal()
            if number == FEW // 2:
                clock.at += by
        assert sum(one.difference for one in twin.packets.account().values()) == 0
        station = twin.inbox.station
        assert station is not None
        rows.append(twin.inbox.packet(station, 0, FEW))
        twin.close()
    calm, found = rows
    assert len(calm.time) > FEW - 5
    np.testing.assert_array_equal(found.time, calm.time)
    np.testing.assert_array_equal(found.readings, calm.readings)


def test_a_diagnosis_that_fails_is_asked_again_later(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    write_service(tmp_path, measured_bridge)
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)
    asked = runner.Running._ask_diagnosis
    failures = iter([InputError("too little is known", "a test", "wait")])

    def fails_once(running: runner.Running) -> Any:
        for one in failures:
            raise one
        return asked(running)

    monkeypatch.setattr(runner.Running, "_ask_diagnosis", fails_once)
    begun = {"settings": tmp_path / "settings.json", "name": "east"}
    with rga.live(tmp_path / "model.json", tmp_path / "east", **begun) as twin:
        twin.feed(record)
        twin.play()
        assert twin.waiting == (0, 0)
        said = [one.words for one in history(twin).events if one.kind == "diagnosis"]
    assert said[0].startswith("not possible yet: too little is known")
    assert len(said) > 1
    assert not said[-1].startswith("not possible yet")
