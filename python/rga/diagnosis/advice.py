"""The added sensor that would tell a cause from its rival, by simulation of both."""

import numpy as np

from rga.diagnosis.data import Data
from rga.errors import InputError
from rga.model.schema import Model, Sensor
from rga.simulation import Simulator

#: what a good sensor resolves [its unit]
RESOLUTION = {"displacement": 0.05, "strain": 1.0}


def separating_sensor(cause: Simulator, rival: Simulator, data: Data) -> str:
    """The one added displacement or strain sensor at which the two differ most, in words.

    Args:
        cause: simulator of the extended model.
        rival: simulator with the rival in the place of the cause.
        data: gives the contexts under which they are compared.
    """
    trial = _everywhere(cause.model)
    try:
        ours, theirs = (
            Simulator(s.model.model_copy(update={"sensors": {**s.model.sensors, **trial}})).predict(
                data.belief.table
            )[:, len(s.model.sensors) :]
            for s in (cause, rival)
        )
    except InputError:
        return ""
    difference = np.sqrt(np.nanmean((ours - theirs) ** 2, axis=0))
    resolved = difference / np.array([RESOLUTION[sensor.kind] for sensor in trial.values()])
    best = int(np.nanargmax(resolved))
    sensor = list(trial.values())[best]
    largest = float(np.nanmax(np.abs(ours - theirs)[:, best]))
    if resolved[best] < 1.0:
        return (
            "no single added displacement or strain sensor under these loads: the two differ by "
            "less than such a sensor resolves; another load case is needed"
        )
    where = (
        f"the strain of member {sensor.member}"
        if sensor.kind == "strain"
        else f"the displacement of node {sensor.node} along {_axis(sensor)}"
    )
    return f"measuring {where}: the two differ there by up to {largest:.3g} {sensor.unit}"


def _everywhere(model: Model) -> dict[str, Sensor]:
    gauged = {sensor.member for sensor in model.sensors.values()}
    sensors = {
        f"strain of {name}": Sensor(kind="strain", member=name, unit="microstrain")
        for name in model.members
        if name not in gauged
    }
    used = {node for member in model.members.values() for node in member.nodes}
    for node in sorted(used):
        for axis, direction in (
            ("x", (1.0, 0.0, 0.0)),
            ("y", (0.0, 1.0, 0.0)),
            ("z", (0.0, 0.0, 1.0)),
        ):
            sensors[f"{axis} of {node}"] = Sensor(
                kind="displacement", node=node, direction=direction, unit="mm"
            )
    return sensors


def _axis(sensor: Sensor) -> str:
    assert sensor.direction is not None  # made with one above
    return "xyz"[int(np.argmax(np.abs(sensor.direction)))]
