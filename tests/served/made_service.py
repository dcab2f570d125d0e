"""A service for tests: the files of its folder."""

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from live_streams import SETTINGS
from rga.operation.feeding.sent_record import SentRecord
from rga.operation.packets.packet import MICROSECONDS
from rga.records import Record
from rga_bench.operation.service_process import free_port

#: 2026-11-23T00:00:00Z
MIDNIGHT = 1_795_392_000_000_000
#: of one twin whose readings come by HTTP, faster than they were measured
HTTP = 'kind = "http"\nclock = { check = false }'
CONFIGURATION = """
[service]
listen = "127.0.0.1:{port}"
[[twin]]
name = "{name}"
model = "model.json"
settings = "settings.json"
rows = {{ every = "10 min", lateness = "30 min" }}
[[twin.source]]
{source}
"""


def write_service(
    folder: Path, model: dict[str, Any], *, name: str = "east", source: str = HTTP
) -> str:
    """Write the files of a service of one twin; gives its address.

    Args:
        folder: that they are written to.
        model: content of the model file.
        name: of the twin.
        source: lines of its one source.
    """
    port = free_port()
    text = CONFIGURATION.format(port=port, name=name, source=source)
    (folder / "serve.toml").write_text(text, "utf-8")
    (folder / "model.json").write_text(json.dumps(model), "utf-8")
    (folder / "settings.json").write_text(SETTINGS.model_dump_json(), "utf-8")
    return f"http://127.0.0.1:{port}"


def sent_of(record: Record) -> SentRecord:
    """A record as a logger has it that began at midnight."""
    return SentRecord(
        (*record.sensors, *record.contexts),
        MIDNIGHT + np.rint(record.time * MICROSECONDS).astype(np.int64),
        np.column_stack([record.readings, *record.contexts.values()]),
        "s",
    )


def waited_for(what: Callable[[], Any], longest: float = 120.0) -> Any:
    """What there is as soon as it is there."""
    until = time.monotonic() + longest
    while not (found := what()):
        assert time.monotonic() < until, "it does not come"
        time.sleep(0.02)
    return found
