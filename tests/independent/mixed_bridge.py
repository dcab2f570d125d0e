"""The bridge of measured modes under two measured loads: gauges beside modes, by plain NumPy."""

from typing import Any

import numpy as np
from scipy.signal import lfilter

from independent.dense_modes import dense_motion
from independent.modal_bridge import Hidden, described, truth
from rga.model import Model, read_model
from rga.records import Record
from rga.records.modal.record import ModalRecord

LOADS = {"west load": ("b2n", "b2s"), "east load": ("b4n", "b3s")}
#: noise of gauges: displacements [mm], strains [microstrain], and their memory
OF_DISPLACEMENT, OF_STRAIN, MEMORY = 0.04, 1.2, 0.3
DEFLECTIONS = ("b1n", "b2n", "b3n", "b4n", "b5n", "b2s", "b3s", "b4s")
STRAINS = (
    "b1n-b2n", "b2n-b3n", "b3s-b4s", "b4s-b5s", "t2n-t3n", "t3s-t4s", "b0n-t1n", "b0s-t1s",
    "t5n-b6n", "b2n-t3n", "t2s-b3s", "b3n-t4n", "b2n-t2n", "b4s-t4s",
)  # fmt: skip


def mixed(
    seed: int, hidden: Hidden, rows: int = 120, heavier: float = 1.0
) -> tuple[Model, Record, ModalRecord]:
    """The truss that an analyst holds, its gauges under two loads, and its modes.

    Args:
        seed: of scatter and noise.
        hidden: what the truth has and the model has not; it acts from the first row on.
        rows: of the record, a minute apart.
        heavier: what the loads are, over what is said of them.
    """
    content, modal = described(seed, hidden)
    content = with_gauges(content)
    model = read_model(content, "bridge")
    rng = np.random.default_rng(seed + 2000)
    built = truth(np.random.default_rng(seed + 1000), hidden, late=True)
    said = {name: 40.0 + 60.0 * rng.random(rows) for name in LOADS}
    nodes = list(built.nodes)
    places = np.array(list(built.nodes.values()))
    readings = np.zeros((rows, len(DEFLECTIONS) + len(STRAINS)))
    for name, loaded in LOADS.items():
        motion = dense_motion(built, dict.fromkeys(loaded, (0.0, 0.0, -500.0)))[:, :3]
        of_unit = [1e3 * motion[nodes.index(node), 2] for node in DEFLECTIONS]
        for member in STRAINS:
            first, last = (nodes.index(node) for node in built.members[member].nodes)
            along = places[last] - places[first]
            of_unit.append(1e6 * float((motion[last] - motion[first]) @ along / (along @ along)))
        readings += np.outer(heavier * said[name], of_unit)
    noise = np.repeat([OF_DISPLACEMENT, OF_STRAIN], [len(DEFLECTIONS), len(STRAINS)])
    steps = rng.standard_normal((rows + 50, len(noise))) * np.sqrt(1.0 - MEMORY**2)
    readings += noise * lfilter([1.0], [1.0, -MEMORY], steps, axis=0)[50:]
    record = Record(
        60.0 * np.arange(rows), 0.0, "seconds", tuple(model.sensors), readings,
        {name: column + 0.1 * rng.standard_normal(rows) for name, column in said.items()},
    )  # fmt: skip
    return model, record, modal


def with_gauges(content: dict[str, Any]) -> dict[str, Any]:
    """The same model file with gauges and the loads under which they are read."""
    content = dict(content)
    content["sensors"] = content["sensors"] | {
        f"D {node}": {
            "kind": "displacement", "node": node, "direction": [0, 0, 1], "unit": "mm",
            "noise": OF_DISPLACEMENT,
        }
        for node in DEFLECTIONS
    } | {
        f"S {member}": {
            "kind": "strain", "member": member, "unit": "microstrain", "noise": OF_STRAIN,
        }
        for member in STRAINS
    }  # fmt: skip
    content["context"] = {name: {"unit": "kN", "range": [0, 120], "noise": 0.1} for name in LOADS}
    content["effects"] = {
        name: {
            "kind": "nodal_load", "forces": {node: [0, 0, -500] for node in loaded},
            "factor": {"context": name},
        }
        for name, loaded in LOADS.items()
    }  # fmt: skip
    return content
