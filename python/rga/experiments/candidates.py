"""What could be measured: sensors that could be added, and states that could be brought about."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from rga.experiments.truck import STANDS, Lane, Truck
from rga.model.schema import MeasuringPoint, Model, Sensor
from rga.model.structure.arrays import HELD_BY_PLANE
from rga.model.units import UNITS

Kind = Literal["displacement", "rotation", "strain"]
#: unit and noise of an added sensor where the model has none of its kind
USUAL = {
    "displacement": ("mm", 0.1),
    "strain": ("microstrain", 1.0),
    "rotation": ("mrad", 0.01),
    "force": ("kN", 1.0),
    "reaction": ("kN", 1.0),
}
#: what a measurement costs, in strain gauges put on: a displacement needs a fixed point beside it
SENSOR_COST: dict[Kind, float] = {"strain": 1.0, "displacement": 1.5, "rotation": 1.5}
#: the same of an instrument for a context, of a stand of a truck, and of a setting of contexts
INSTRUMENT_COST, STAND_COST, SETTING_COST = 0.5, 1.0, 1.0
#: kinds of what is no sensor of the vocabulary, and of tests
ACCELEROMETER, INSTRUMENT, LOAD_TEST, SETTING = (
    "accelerometer", "instrument", "load test", "set context",
)  # fmt: skip
#: share of a context's range that a test can bring about, about its middle
ATTAINABLE = 0.8
#: noise of a context's measurement where the model states none [its range]
CONTEXT_NOISE = 0.01


@dataclass(frozen=True)
class Added:
    """A sensor that could be added, or a second instrument for a context.

    Attributes:
        name: new to the model.
        sensor: as it would stand in the model; None for an instrument.
        context: that the instrument measures; empty for a sensor.
        words: where it goes.
        unit, noise: of a reading.
        cost: in strain gauges put on.
        point: of an accelerometer, as it would stand in the model; None for anything else.
    """

    name: str
    sensor: Sensor | None
    context: str
    words: str
    unit: str
    noise: float
    cost: float
    point: MeasuringPoint | None = None

    @property
    def kind(self) -> str:
        """Of the sensor."""
        if self.point is not None:
            return ACCELEROMETER
        return INSTRUMENT if self.sensor is None else self.sensor.kind

    @property
    def deed(self) -> str:
        """What is to be done, in words."""
        return f"{'put' if self.point is not None else 'measure'} {self.words}"

    @property
    def advice(self) -> str:
        """As an advice has it."""
        return self.words if self.point is not None else f"measuring {self.words}"


@dataclass(frozen=True)
class LoadTest:
    """Two states whose readings, or whose modes, are compared.

    Attributes:
        words: what is done.
        at, against: contexts that differ from their rest, in both states.
        position: of the truck in the first [m]; None without a truck.
        cost: in strain gauges put on.
        truck: what it weighs, in words; empty without a truck.
        kind: of the test.
    """

    words: str
    at: dict[str, float]
    against: dict[str, float]
    position: float | None
    cost: float
    truck: str = ""
    kind: str = LOAD_TEST

    @property
    def advice(self) -> str:
        """As an advice has it, the truck with it."""
        words = f"a load test, {self.words},"
        return f"{words} {self.truck}," if self.truck else words


def added_sensors(model: Model) -> list[Added]:
    """Displacements and tilts of nodes, strains of members; then instruments for contexts."""
    held = HELD_BY_PLANE.get(model.plane or "", ())
    members = model.members.values()
    used = {node for member in members for node in member.nodes}
    stiff = {node for member in members if member.kind == "frame" for node in member.nodes}
    like = {kind: _like(model, kind) for kind in SENSOR_COST}

    def added(words: str, kind: Kind, **where: Any) -> Added:
        sensor = like[kind].model_copy(update=where)
        assert sensor.noise is not None  # given by `_like`
        cost = SENSOR_COST[kind]
        name = f"{words} (added)"
        return Added(name, sensor, "", f"the {words}", sensor.unit, sensor.noise, cost)

    found = []
    kinds: tuple[tuple[Kind, str, set[str], int], ...] = (
        ("displacement", "displacement of node {} along {}", used, 0),
        ("rotation", "tilt of node {} about {}", stiff, 3),
    )
    for number, axis in enumerate("xyz"):
        direction = tuple(np.eye(3)[number].tolist())
        for kind, words, nodes, first in kinds:
            if first + number not in held:
                found += [
                    added(words.format(node, axis), kind, node=node, direction=direction)
                    for node in model.nodes
                    if node in nodes
                ]
    found += [added(f"strain of member {name}", "strain", member=name) for name in model.members]
    return [*found, *(_instrument(model, name) for name in model.context)]


def _like(model: Model, kind: Kind) -> Sensor:
    """A sensor of a kind, with unit and noise as the model's or as usual; its place is open."""
    units = (one.unit for one in model.sensors.values() if one.kind == kind)
    sensor = Sensor.model_construct(kind=kind, unit=next(units, USUAL[kind][0]))
    return sensor.model_copy(update={"noise": sensor_noise(model, sensor)})


def context_noise(model: Model, name: str) -> float:
    """Standard deviation of a measurement of a context [its unit]."""
    low, high = model.context[name].range
    return model.context[name].noise or CONTEXT_NOISE * (high - low)


def rest(model: Model) -> dict[str, float]:
    """Every context at rest: nothing where its range has that, else the middle of the range."""
    return {
        name: 0.0 if variable.range[0] <= 0 <= variable.range[1] else sum(variable.range) / 2
        for name, variable in model.context.items()
    }


def settings(model: Model, needed: Collection[str]) -> list[LoadTest]:
    """A contrast of every context that matters: high in its range against low."""
    found = []
    for name in model.context:
        if name in needed:
            variable = model.context[name]
            middle = sum(variable.range) / 2
            half = ATTAINABLE * (variable.range[1] - variable.range[0]) / 2
            low, high = middle - half, middle + half
            words = f"{name} at {high:.3g} against {low:.3g} {variable.unit}, a week apart"
            found.append(
                LoadTest(words, {name: high}, {name: low}, None, SETTING_COST, "", SETTING)
            )
    return found


def stands(lane: Lane, truck: Truck, most: int = STANDS) -> list[LoadTest]:
    """The truck at each of its places, so many at most, against no truck."""
    return [
        LoadTest(
            f"{lane.load} at {place:.2f} m (node {lane.nearest(place)})",
            {},
            {},
            place,
            STAND_COST,
            lane.described(truck),
        )
        for place in lane.stands(truck, most)
    ]


def _instrument(model: Model, name: str) -> Added:
    return Added(
        f"second instrument for {name}",
        None,
        name,
        f"{name} with a second, calibrated instrument",
        model.context[name].unit,
        context_noise(model, name),
        INSTRUMENT_COST,
    )


def sensor_noise(model: Model, sensor: Sensor) -> float:
    """Standard deviation of one reading: the sensor's own, that of its like, or what is usual."""
    if sensor.noise is not None:
        return sensor.noise
    per_si = UNITS[sensor.kind]
    known = [
        one.noise / per_si[one.unit]
        for one in model.sensors.values()
        if one.kind == sensor.kind and one.noise is not None
    ]
    unit, noise = USUAL[sensor.kind]
    return (float(np.median(known)) if known else noise / per_si[unit]) * per_si[sensor.unit]
