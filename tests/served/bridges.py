"""What tests of the pages share: a service with twins that have lived through something."""

import json
from collections.abc import Sequence
from datetime import datetime, timedelta
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

import rga
from live_streams import SETTINGS
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import EPOCH, Number, SensorPacket
from rga.operation.served_twin import ServedTwin
from rga.records import Record

#: names of sensors that a page must not fall for
HOSTILE = (
    "<script>alert('S')</script>",
    '" onmouseover="alert(1)',
    "梁の歪み ёмкость حساس",
    "a very long name " * 10 + "of a sensor",
    "../S?name=1&x=%2F#y",
)
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


def long_bridge(panels: int, name: str = "long bridge") -> dict[str, Any]:
    """A model file: a truss with a gauge on every member and a deflection at every lower node.

    Names of its first sensors are those that a page must not fall for.
    """
    lower = [f"L{k}" for k in range(panels + 1)]
    upper = [f"U{k}" for k in range(1, panels)]
    nodes = {node: [4.0 * k, 0, 0] for k, node in enumerate(lower)}
    nodes |= {node: [4.0 * k, 0, 10.0] for k, node in enumerate(upper, 1)}
    bars = [*pairwise(lower), *pairwise(upper), *zip(lower[1:-1], upper, strict=True)]
    half = panels // 2
    bars += [(lower[k - 1], upper[k - 1]) for k in range(1, half + 1)]
    bars += [(lower[k + 1], upper[k - 1]) for k in range(half, panels)]
    members = {
        f"{a}-{b}": {"nodes": [a, b], "section": "bar", "material": "steel", "groups": ["bars"]}
        for a, b in bars
    }
    strain = {"kind": "strain", "unit": "microstrain", "noise": 1.0}
    deflection = {"kind": "displacement", "direction": [0, 0, 1], "unit": "mm", "noise": 0.05}
    places = [strain | {"member": bar} for bar in members]
    places += [deflection | {"node": node} for node in lower[1:-1]]
    names = [*HOSTILE, *(f"S{k}" for k in range(len(HOSTILE), len(places)))]
    return {
        "rga_model": 1,
        "name": name,
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": nodes,
        "members": members,
        "supports": {
            "west": {"node": lower[0], "fixed": ["ux", "uz"]},
            "east": {"node": lower[-1], "fixed": ["uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.3},
            "west load": {"unit": "kN", "range": [0, 100], "noise": 0.1},
            "east load": {"unit": "kN", "range": [0, 100], "noise": 0.1},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"bars": 1.0},
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "west": _load(lower[half // 2 + 1], "west load"),
            "east": _load(lower[-half // 2 - 1], "east load"),
        },
        "sensors": dict(zip(names, places, strict=True)),
    }


def _load(node: str, context: str) -> dict[str, Any]:
    forces = {node: [0, 0, -1000]}
    return {"kind": "nodal_load", "forces": forces, "factor": {"context": context}}
