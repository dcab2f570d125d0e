"""Channels of a record broken, as a trial has them."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.model import Model
from rga.records import Record
from rga_bench.faults.library import FAULTS, Array, Scale
from rga_bench.faults.trial import LEFT_OUT, SOUND, FaultTrial

#: root of the mean square that a fault adds from its onset on, in the channel's noise: less is
#: no broken channel, as with a sign turned where nothing is read
PLAIN = 3.0
#: of the rows, between which a fault begins late
ONSETS = (0.2, 0.7)
#: share of the channels that break together: three of twenty
SEVERAL = 0.15


def broken(trial: FaultTrial, model: Model, record: Record) -> tuple[Record, list[dict[str, Any]]]:
    """The record of a trial, and its broken channels with `sensor`, `fault` and first `row`."""
    if trial.way == SOUND:
        return record, []
    rng = np.random.default_rng([trial.seed, trial.number, *f"{trial.base.name}".encode()])
    several = max(3, int(SEVERAL * len(record.sensors)))
    if trial.way == LEFT_OUT:
        gone = rng.choice(len(record.sensors), several, replace=False)
        return _without(record, gone)
    many = {"pair": 2, "several": several}.get(trial.way, 1)
    others = [name for name in FAULTS if name != trial.fault]
    faults = [trial.fault, *(others[k] for k in rng.choice(len(others), many - 1, replace=False))]
    readings = record.readings.copy()
    faulty: list[dict[str, Any]] = []
    for fault in faults:
        late = trial.way == "late" or (many > 1 and rng.random() < 0.5)
        row = int(rng.uniform(*ONSETS) * len(record)) if late else 0
        taken = {one["sensor"] for one in faulty}
        column, spoiled = _spoiled(fault, rng, model, record, row, taken)
        readings[:, column] = spoiled
        faulty.append({"sensor": record.sensors[column], "fault": fault, "row": row})
    return replace(record, readings=readings), faulty


def _spoiled(
    fault: str,
    rng: np.random.Generator,
    model: Model,
    record: Record,
    row: int,
    taken: set[str],
) -> tuple[int, Array]:
    """A channel on which the fault is plain, or plainest, and what it reads then [rows]."""
    best: tuple[float, int, Array] | None = None
    for column in rng.permutation(len(record.sensors)):
        sensor = model.sensors[record.sensors[column]]
        if record.sensors[column] in taken:
            continue
        sound = record.readings[:, column]
        scale = Scale.of(sensor.model_dump(), sound)
        other = record.readings[:, _other(rng, model, record, int(column))]
        spoiled = FAULTS[fault].spoil(sound, rng, scale, other, row)
        change = (spoiled - sound)[row:]
        known = change[np.isfinite(change)]
        plain = float(np.sqrt((known**2).mean())) / scale.noise if len(known) else 0.0
        if best is None or plain > best[0]:
            best = plain, int(column), spoiled
        if plain >= PLAIN:
            break
    assert best is not None
    return best[1:]


def _other(rng: np.random.Generator, model: Model, record: Record, column: int) -> int:
    """Another channel, of the same unit where there is one."""
    unit = model.sensors[record.sensors[column]].unit
    others = [k for k in range(len(record.sensors)) if k != column]
    alike = [k for k in others if model.sensors[record.sensors[k]].unit == unit]
    several = alike or others
    return several[int(rng.integers(len(several)))]


def _without(record: Record, gone: NDArray[np.int64]) -> tuple[Record, list[dict[str, Any]]]:
    kept = np.setdiff1d(np.arange(len(record.sensors)), gone)
    sensors = tuple(record.sensors[k] for k in kept)
    left_out = [{"sensor": record.sensors[k], "fault": LEFT_OUT, "row": 0} for k in np.sort(gone)]
    return replace(record, sensors=sensors, readings=record.readings[:, kept]), left_out
