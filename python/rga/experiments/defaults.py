"""What is usual where the user says nothing: operation, and a truck that the structure bears."""

import numpy as np

from rga.arrays import FloatArray
from rga.experiments.candidates import rest
from rga.experiments.truck import FACTOR, POSITION, Lane, Truck
from rga.model.effect import Values
from rga.model.effects.loads.load_mass import GRAVITY
from rga.model.mass_budget import mass_budget
from rga.model.schema import ContextVariable, Model, Sensor
from rga.simulation import Simulator

#: rows of operation, the time between them [s], and the share of each range that they swing through
ROWS, INTERVAL, SWING = 24, 7200.0, 0.5
#: ratio of the paces of contexts: swings at such paces never come to repeat each other
GOLDEN = (1 + 5**0.5) / 2
#: states of the loads of a model that are looked at
STATES = 64
#: where the model has no load to compare with: share of the structure's mass that a truck weighs,
#: and an axle load where it has no mass either [kN]; spacing of the axles [m]
PARKED, AXLE, SPACING = 0.05, 50.0, 4.0


def usual_operation(model: Model) -> Values:
    """Two days, every context swinging about the middle of its range at a pace of its own."""
    table: Values = {"time": INTERVAL * np.arange(ROWS, dtype=np.float64)}
    days = table["time"] / 86400.0
    for number, (name, variable) in enumerate(model.context.items()):
        low, high = variable.range
        wave = np.sin(2 * np.pi * GOLDEN**number * days)
        table[name] = (low + high) / 2 + SWING * (high - low) / 2 * wave
    return table


def usual_truck(model: Model, lane: Lane) -> Truck:
    """Two like axles that strain no member more than the loads of the model strain the worst.

    Where it has no loads, they weigh a small share of the structure.
    """
    spacing = round(min(SPACING, lane.length / 4), 2)
    truck = Truck((AXLE, AXLE), (spacing,))
    share = strain_share(model, lane, truck)
    mass = sum(part.total for part in mass_budget(model))
    weight = PARKED * mass * GRAVITY / 2e3 if mass > 0 else AXLE
    load = AXLE / share if share > 0 else weight
    digits = 10.0 ** (np.floor(np.log10(load)) - 1)
    load = float(max(np.floor(load / digits), 1.0) * digits)
    return Truck((load, load), (spacing,))


def strain_share(model: Model, lane: Lane, truck: Truck) -> float:
    """Largest strain under a truck over the largest under the loads of the model; 0: no loads."""
    sensors = {
        name: Sensor(kind="strain", member=name, unit="microstrain") for name in model.members
    }
    contexts = {
        **model.context,
        FACTOR: ContextVariable(unit="-", range=(0.0, 1.0)),
        POSITION: ContextVariable(unit="m", range=(0.0, max(lane.length, 1.0))),
    }
    gauged = model.with_sensors(sensors)
    changes = {"context": contexts, "effects": {**gauged.effects, **lane.effects(truck)}}
    simulator = Simulator(gauged.model_copy(update=changes))
    moved = {
        context
        for effect in model.effects.values()
        if effect.is_load or any(mark.of == "effect" for mark in effect.place_fields().values())
        for context in effect.drivers()
    }
    places = lane.stands(truck)
    number = np.arange(1, STATES + 1)
    still = rest(model)
    table: Values = {"time": np.zeros(1 + STATES + len(places))}
    for k, name in enumerate(contexts):
        column = np.full(len(table["time"]), still.get(name, 0.0))
        if name in moved:
            low, high = contexts[name].range
            column[1 : 1 + STATES] = low + (high - low) * (number * GOLDEN ** (k + 1) % 1.0)
            column[STATES] = high
        table[name] = column
    table[FACTOR][1 + STATES :] = 1.0
    table[POSITION][1 + STATES :] = places
    strain = simulator.predict(table)
    change = np.abs(strain[1:] - strain[0])
    own, trucks = _largest(change[:STATES]), _largest(change[STATES:])
    return trucks / own if own > 1e-9 * trucks else 0.0


def _largest(values: FloatArray) -> float:
    return float(values.max(initial=0.0))
