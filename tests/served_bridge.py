"""What tests of the pages share: a service with twins that have lived through something."""

import json
from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

import rga
from live_streams import SETTINGS
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import EPOCH, Number, SensorPacket
from rga.operation.served_twin import ServedTwin
from rga.records import Record

_HEAD = '[service]\ndata = "data"\n'
_TWIN = """
[[twin]]
name = "{name}"
model = "{name}.json"
settings = "settings.json"
rows = {{ every = "10 min", lateness = "10 min" }}
[[twin.source]]
kind = "http"
clock = {{ check = false }}
"""


def configured(folder: Path, models: dict[str, dict[str, Any]]) -> Path:
    """The configuration of a service of twins, beside the files that it names.

    Args:
        folder: of them.
        models: contents of the model files, by name of the twin.
    """
    for name, model in models.items():
        (folder / f"{name}.json").write_text(json.dumps(model), "utf-8")
    settings = SETTINGS.model_dump(mode="json", exclude={"adopt"})
    (folder / "settings.json").write_text(json.dumps(settings), "utf-8")
    path = folder / "serve.toml"
    path.write_text(_HEAD + "".join(_TWIN.format(name=name) for name in models), "utf-8")
    return path


def packets_of(
    record: Record, start: datetime, stream: str | None = "s", left_out: Sequence[int] = ()
) -> list[bytes]:
    """The rows of a record, each as a packet, as a logger sends them.

    Args:
        start: time of the first row.
        stream: under which the logger counts; None: it does not.
        left_out: numbers of packets that are lost.
    """
    names = (*record.sensors, *record.contexts)
    values = np.column_stack([record.readings, *record.contexts.values()])
    first = (start - EPOCH) // timedelta(microseconds=1)
    times = first + np.round(record.time * 1e6).astype(np.int64)
    found = []
    for number in range(len(record)):
        row = slice(number, number + 1)
        counted = None if stream is None else Number(stream, number)
        if number not in left_out:
            found.append(write_packet(SensorPacket(counted, names, times[row], values[row])))
    return found


def lived(twin: ServedTwin, payloads: Sequence[bytes]) -> None:
    """Let a twin take packets in, and play all that is due."""
    for payload in payloads:
        twin.receive("http", [("http", payload)])
    played(twin)


def played(twin: ServedTwin) -> None:
    """Seal what has come, and play all that is due."""
    twin.seal()
    with rga.LiveTwin(twin.directory) as live:
        live.play()
