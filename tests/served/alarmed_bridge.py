"""A service with alarms that is looked at by hand, and a logger that sends to it."""

import json
from pathlib import Path
from typing import Any

import numpy as np

import rga
from live_streams import SETTINGS, sinking
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import Number, SensorPacket
from rga.operation.service import Service
from rga.operation.service_clock import microseconds
from rga.records import Record
from served.service_times import NOON, SetClock

CONFIGURATION = """
[service]
data = "data"
[alarms]
lag = "5 h"
[alarms.source]
on = "0 s"
[[notify]]
url_file = "mail.secret"
on = ["gap", "quality", "source", "service", "proposal"]
"""
TWIN = """
[[twin]]
name = "{name}"
model = "model.json"
settings = "settings.json"
rows = {{ every = "10 min", lateness = "30 min", patience = "1 h" }}
[[twin.source]]
kind = "http"
"""
EVERY, PATIENCE = 600.0, 3600.0
MICROSECONDS_OF_A_ROW = round(EVERY * 1e6)


class Bridge:
    """A service that is looked at by hand, with a logger that sends a row every ten minutes."""

    def __init__(self, folder: Path, record: Record, twins: tuple[str, ...] = ("east",)) -> None:
        self.folder, self.record, self.clock = folder, record, SetClock()
        text = CONFIGURATION + "".join(TWIN.format(name=name) for name in twins)
        (folder / "serve.toml").write_text(text, "utf-8")
        (folder / "mail.secret").write_text("json://127.0.0.1:9", "utf-8")
        self.sent = 0
        self.start()

    def start(self) -> None:
        self.service = Service(read_configuration(self.folder / "serve.toml"), self.clock)

    def restart(self) -> None:
        self.service.stop()
        self.start()

    def send(self, rows: int = 1, skipped: int = 0, spoil: Any = None, twin: str = "east") -> None:
        """Let rows pass, each sent at its time and played."""
        for _ in range(rows):
            self.clock.pass_by(EVERY)
            self.receive(self.sent, spoil, twin)
            self.sent += 1
            self.look(play=self.sent % 10 == 0)
        self.sent += skipped

    def receive(
        self, number: int, spoil: Any = None, twin: str = "east", known: Number | None = None
    ) -> None:
        names = (*self.record.sensors, *self.record.contexts)
        row = number % len(self.record)
        values = np.array(
            [*self.record.readings[row], *(one[row] for one in self.record.contexts.values())]
        )
        if spoil is not None:
            spoil(values)
        times = microseconds(NOON) + np.array([number * MICROSECONDS_OF_A_ROW])
        packet = SensorPacket(known or Number("s", number), names, times, values[None])
        self.service.twins[twin].receive("http", [("http", write_packet(packet, binary=True))])

    def wait(self, seconds: float) -> None:
        """Let time pass in which nothing is sent."""
        for _ in range(round(seconds / 60)):
            self.clock.pass_by(60)
            self.look(play=False)

    def look(self, play: bool) -> None:
        for twin in self.service.twins.values():
            twin.seal()
            if play:
                with rga.LiveTwin(twin.directory) as live:
                    live.play()
        self.service.supervision.round()

    @property
    def changes(self) -> list[tuple[str, str, str]]:
        """Class, cause and change of all transitions."""
        book = self.service.alarms
        return [
            (alarm.kind, alarm.cause, one.change)
            for one in book.transitions(0, 1000)
            for alarm in [book.of(one.alarm)]
        ]

    @property
    def notices(self) -> int:
        """Notices that were written."""
        with self.service._file.reading() as connection:
            return len(connection.exec_driver_sql("SELECT * FROM notice").all())


def made(folder: Path, content: dict[str, Any], measured: Any, rows: int, sinks: bool) -> Bridge:
    """A bridge in a folder of its own."""
    folder.mkdir(exist_ok=True)
    (folder / "model.json").write_text(json.dumps(content), "utf-8")
    settings = SETTINGS.model_dump(mode="json") | {"adopt": "ask"}
    (folder / "settings.json").write_text(json.dumps(settings), "utf-8")
    return Bridge(folder, sinking(read_model(content, "bridge"), measured, rows, sinks=sinks))
