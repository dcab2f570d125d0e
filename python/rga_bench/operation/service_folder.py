"""The files of a service of one twin."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from rga.operation.feeding.sent_record import SentRecord
from rga.operation.packets.packet import MICROSECONDS
from rga.records import Record
from rga.twin import Settings
from rga_bench.operation.service_process import free_port

#: 2026-11-23T00:00:00Z
MIDNIGHT = 1_795_392_000_000_000
#: of one twin whose readings come by HTTP, faster than they were measured
HTTP = 'kind = "http"\nclock = { check = false }'
#: where a logger sends to by a broker
TOPIC = "rga/v1/east/data/logger"
CONFIGURATION = """
[service]
listen = "127.0.0.1:{port}"
[[twin]]
name = "{name}"
model = "model.json"
settings = "settings.json"
rows = {{ every = "{every} s", lateness = "{lateness} s" }}
[[twin.source]]
{source}
"""


def write_service(
    folder: Path,
    model: dict[str, Any],
    settings: Settings,
    *,
    name: str = "east",
    source: str = HTTP,
    every: int = 600,
    lateness: int = 1800,
) -> str:
    """Write the files of a service of one twin; gives its address.

    Args:
        folder: that they are written to.
        model: content of the model file.
        settings: of the twin.
        name: of the twin.
        source: lines of its one source.
        every: length of a row [s].
        lateness: by which samples may come after others of later times [s].
    """
    port = free_port()
    text = CONFIGURATION.format(port=port, name=name, source=source, every=every, lateness=lateness)
    (folder / "serve.toml").write_text(text, "utf-8")
    (folder / "model.json").write_text(json.dumps(model), "utf-8")
    (folder / "settings.json").write_text(settings.model_dump_json(), "utf-8")
    return f"http://127.0.0.1:{port}"


def by_broker(url: str) -> str:
    """Lines of a source behind a broker, of records that are played faster than measured."""
    return f'kind = "mqtt"\nurl = "{url}"\ntopics = ["{TOPIC}"]\nclock = {{ check = false }}'


def sent_of(record: Record) -> SentRecord:
    """A record as a logger has it that began at midnight."""
    return SentRecord(
        (*record.sensors, *record.contexts),
        MIDNIGHT + np.rint(record.time * MICROSECONDS).astype(np.int64),
        np.column_stack([record.readings, *record.contexts.values()]),
        "s",
    )
