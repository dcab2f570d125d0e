"""What could be measured of modes: accelerometers, and windows under other circumstances."""

from collections.abc import Collection

import numpy as np

from rga.experiments.candidates import ATTAINABLE, Added, LoadTest
from rga.experiments.truck import STANDS, Lane, Truck
from rga.findings.schema import Windows
from rga.model import Model
from rga.model.schema import MeasuringPoint
from rga.model.structure.arrays import HELD_BY_PLANE
from rga.planning.modal.practical import mass_of

#: what a measurement costs, in strain gauges put on: windows cost waiting, a season most of it
ACCELEROMETER_COST, PARKED_COST, WINDOWS_COST, SEASON_COST = 1.0, 1.5, 0.5, 2.0
#: windows through which a known mass is left where it stands
PARKED_WINDOWS = 10
#: kinds of tests
PARKED_MASS, MORE_WINDOWS, SEASON = "parked mass", "more windows", "season"
#: parts of a context's range that a season must add to what the windows had
WIDER = 0.1
AXES = "xyz"


def accelerometers(model: Model) -> list[Added]:
    """One at every node along every axis along which it may move and none measures yet."""
    held = HELD_BY_PLANE.get(model.plane or "", ())
    fixed = {(support.node, dof) for support in model.supports.values() for dof in support.fixed}
    there = {
        (one.node, int(np.argmax(np.abs(one.direction))))
        for one in model.points.values()
        if np.count_nonzero(one.direction) == 1
    }
    used = {node for member in model.members.values() for node in member.nodes}
    found = []
    for node in model.nodes:
        for number, axis in enumerate(AXES):
            free = number not in held and (node, f"u{axis}") not in fixed
            if node not in used or not free or (node, number) in there:
                continue
            direction = tuple(np.eye(3)[number].tolist())
            words = f"an accelerometer at {node} along {axis}"
            point = MeasuringPoint(node=node, direction=direction)
            name = f"motion of {node} along {axis} (added)"
            found.append(Added(name, None, "", words, "-", 0.0, ACCELEROMETER_COST, point))
    return found


def parked(lane: Lane, truck: Truck) -> list[LoadTest]:
    """The truck left at each of its places while modes are measured, against the windows so far."""
    return [
        LoadTest(
            f"{lane.load} at {place:.2f} m (node {lane.nearest(place)}), left there with a known "
            f"mass of {mass_of(truck):.3g} t through {PARKED_WINDOWS} windows of modes",
            {},
            {},
            place,
            PARKED_COST,
            lane.described(truck),
            PARKED_MASS,
        )
        for place in lane.stands(truck, STANDS)
    ]


def more_windows(windows: Windows) -> LoadTest:
    """As many windows again."""
    words = f"{windows.count} more windows of modes, as those so far"
    return LoadTest(words, {}, {}, None, WINDOWS_COST, kind=MORE_WINDOWS)


def seasons(model: Model, windows: Windows, weather: Collection[str]) -> list[LoadTest]:
    """Windows over a wider range of each context that the weather makes.

    Args:
        model: gives the ranges.
        windows: those so far.
        weather: contexts that may move modes beside what the model says.
    """
    found = []
    for name, (lowest, highest) in windows.contexts.items():
        if name not in weather:
            continue
        variable = model.context[name]
        whole = variable.range[1] - variable.range[0]
        middle, half = sum(variable.range) / 2, ATTAINABLE * whole / 2
        low, high = min(lowest, middle - half), max(highest, middle + half)
        if (high - low) - (highest - lowest) < WIDER * whole:
            continue
        words = (
            f"{windows.count} windows of modes over a season, {name} from {low:.3g} to {high:.3g} "
            f"{variable.unit}"
        )
        test = LoadTest(words, {name: high}, {name: low}, None, SEASON_COST, kind=SEASON)
        found.append(test)
    return found
