"""Rows that are followed packet by packet read what they read all together."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import read_model
from rga.model.effect import Effect, Past
from rga.simulation import Memory, Simulator

ROWS, HOUR = 300, 3600.0
ONSET = 100.5 * HOUR
LAG = {"kind": "thermal_lag", "time_constant": 5.0}
CLOCK = {"kind": "clock_lag", "time": 2.4 * HOUR}
LATE_SENSORS = {"kind": "clock_lag", "sensor": ["u", "e"], "time": 7.7 * HOUR}
DRIFT = {"kind": "sensor_drift", "sensor": "e", "rate": 3.0}
CREEP = {"kind": "creep", "amplitude": 0.3}
FRICTION = {
    "kind": "bearing_friction", "support": ["B", "C"], "dof": "ux", "mu": 0.05,
    "permanent_force": 2e5,
}  # fmt: skip
TRAIN = {
    "kind": "axle_load", "path": ["A", "B", "C"], "forces": [1e4, 2e4], "offsets": [0.0, 3.0],
    "direction": [1, 0, -1], "position": {"context": "train"}, "carried_by": "nodes",
}  # fmt: skip
ALONE: dict[str, dict[str, Any]] = {
    "lag": LAG,
    "driven lag": {**LAG, "time_constant": {"context": "air", "times": 0.3, "minus": -20}},
    "clock": CLOCK,
    "sensors": LATE_SENSORS,
    "drift": DRIFT,
    "creep": CREEP,
    "friction": FRICTION,
    "train": TRAIN,
}
RAMP = {"onset": ONSET, "end": 2 * ONSET, "profile": "ramp"}


def truss(**effects: dict[str, Any]) -> Simulator:
    """Three nodes in a plane, two on bearings: pulled, warmed, and with these effects as well."""
    content = {
        "rga_model": 1,
        "name": "truss",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": {"A": [0, 0, 0], "B": [5, 0, 0], "C": [9, 0, 0], "D": [5, 0, 4]},
        "members": {
            ends: {"nodes": list(ends), "section": "bar", "material": "steel", "groups": ["all"]}
            for ends in ("AB", "BC", "AD", "BD", "CD")
        },
        "supports": {
            "A": {"node": "A", "fixed": ["ux", "uy", "uz"]},
            "B": {"node": "B", "fixed": ["uy", "uz"]},
            "C": {"node": "C", "fixed": ["uy", "uz"]},
            "D": {"node": "D", "fixed": ["uy"]},
        },
        "context": {
            "pull": {"unit": "N", "range": [-1e5, 1e5]},
            "air": {"unit": "degC", "range": [-20, 40]},
            "train": {"unit": "m", "range": [-10, 20]},
        },
        "effects": {
            "pull": {
                "kind": "nodal_load",
                "forces": {"C": [1, 0, -1]},
                "factor": {"context": "pull"},
            },
            "weight": {"kind": "nodal_load", "forces": {"D": [0, 0, -1e5]}},
            "warmth": {
                "kind": "temperature",
                "groups": {"all": 1.0},
                "delta": {"context": "air", "minus": 10.0},
            },
            **effects,
        },
        "sensors": {
            "u": {"kind": "displacement", "node": "C", "direction": [1, 0, 0], "unit": "mm"},
            "e": {"kind": "strain", "member": "AB", "unit": "microstrain"},
            "r": {"kind": "reaction", "node": "A", "direction": [1, 0, 0], "unit": "kN"},
        },
    }
    return Simulator(read_model(content, "test"))


def rows(seed: int, count: int = ROWS) -> dict[str, FloatArray]:
    """Contexts of rows about an hour apart, some of them at the same moment."""
    generator = np.random.default_rng(seed)
    steps = np.where(generator.random(count) < 0.1, 0.0, 2 * generator.random(count)) * HOUR
    time = 1.7e9 + np.cumsum(steps) if seed % 2 else np.cumsum(steps)
    return {
        "time": time,
        "pull": 5e4 * generator.standard_normal(count),
        "air": 10 + 15 * np.sin(time / (4 * HOUR)) + generator.standard_normal(count),
        "train": np.linspace(12, -3, count),
    }


def followed(simulator: Simulator, contexts: dict[str, FloatArray], cuts: list[int]) -> FloatArray:
    """Readings of packets between cuts, with the memory stored and read between them."""
    memory, parts = None, []
    for first, end in pairwise([0, *cuts, len(contexts["time"])]):
        packet = {name: column[first:end] for name, column in contexts.items()}
        found = simulator.follow(packet, memory)
        parts.append(found.readings)
        memory = Memory.from_bytes(found.memory.to_bytes())
        assert memory.to_bytes() == found.memory.to_bytes()
    return np.concatenate(parts)


def random_cuts(seed: int) -> list[int]:
    """Some packets of any size, and some of one row."""
    generator = np.random.default_rng(seed)
    cuts = generator.choice(np.arange(2, ROWS), size=generator.integers(1, 12), replace=False)
    return sorted({*cuts.tolist(), *range(150, 156)})


def check(simulator: Simulator, seed: int, *, apart: bool = False) -> None:
    contexts = rows(seed)
    if apart:
        contexts["time"] = contexts["time"] + np.arange(ROWS)
    whole = simulator.predict(contexts)
    scale = np.abs(whole).max(axis=0)
    assert (scale > 0).all()
    assert followed(simulator, contexts, random_cuts(seed)) / scale == pytest.approx(
        whole / scale, abs=1e-12
    )


@pytest.mark.parametrize("name", ALONE)
@pytest.mark.parametrize("begins", [{}, {"onset": ONSET}, RAMP])
@pytest.mark.parametrize("seed", range(2))
def test_one_effect(name: str, begins: dict[str, Any], seed: int) -> None:
    if name == "friction" and "profile" in begins:
        pytest.skip("friction that grows would start anew with each row")
    origin = 1.7e9 if seed % 2 else 0.0
    moments = {key: origin + one for key, one in begins.items() if not isinstance(one, str)}
    # Of two rows at one moment a clock that is not late yet shows the second, come or not.
    check(
        truss(it={**ALONE[name], **begins, **moments}), seed, apart="clock" in ALONE[name]["kind"]
    )


@pytest.mark.parametrize("seed", range(4))
def test_all_effects_together(seed: int) -> None:
    onset = ONSET + (1.7e9 if seed % 2 else 0.0)
    late = {**DRIFT, "sensor": "u", "onset": onset}
    check(truss(**ALONE, late_drift=late, slack={**LAG, "onset": onset}), seed)


def test_what_parameters_keep_has_every_bit() -> None:
    """Readings round with the number of rows, as products of matrices do."""
    contexts, simulator = rows(1), truss(lag=LAG, clock=CLOCK, creep=CREEP)
    whole = simulator.resolve(contexts)
    pasts: dict[str, Past] = {name: {} for name in ("lag", "clock", "creep")}
    for first, end in pairwise([0, 1, 90, 91, 200, ROWS]):
        effects = simulator.model.effects
        going_on = {
            name: effect.going_on(pasts[name]) if name in pasts else effect
            for name, effect in effects.items()
        }
        packet = {name: column[first:end] for name, column in contexts.items()}
        for name, values in simulator.resolve(packet, going_on).items():
            for key, column in values.items():
                assert (column == whole[name][key][first:end]).all(), (name, key)


def test_friction_that_changes_its_structure_and_back() -> None:
    simulator = truss(
        friction=FRICTION,
        soft={"kind": "member_stiffness", "member": "BD", "factor": {"context": "train"}},
    )
    contexts = rows(1)
    contexts["train"] = np.repeat([1.0, 0.5, 1.0], ROWS // 3)
    whole = simulator.predict(contexts)
    assert followed(simulator, contexts, [40, 100, 101, 170, 250]) == pytest.approx(
        whole, rel=1e-12, abs=1e-12
    )
    contexts["train"] = np.repeat([1.0, 0.5, 1.0, 0.5, 1.0, 0.5], ROWS // 6)
    for simulate in (simulator.predict, lambda given: followed(simulator, given, [40, 170])):
        with pytest.raises(InputError, match=r"changes [45] times"):
            simulate(contexts)


def test_a_train_heads_as_from_the_row_before() -> None:
    simulator, contexts = truss(train=TRAIN), rows(0)
    whole = simulator.predict(contexts)
    singly = followed(simulator, contexts, [*range(2, ROWS)])
    assert singly == pytest.approx(whole, rel=1e-12, abs=1e-12)
    # Of the first row alone nobody can tell that the train is reversed.
    first = simulator.follow({name: column[:1] for name, column in contexts.items()}).readings
    assert np.abs(first - whole[:1]).max() > 1e-3


def test_what_is_kept_does_not_grow() -> None:
    simulator = truss(**ALONE)
    memory, sizes = None, []
    for first in range(0, 3000, 300):
        packet = rows(0) | {"time": HOUR * np.arange(first, first + ROWS)}
        memory = simulator.follow(packet, memory).memory
        sizes.append(len(memory.to_bytes()))
    assert max(sizes) < 1.1 * sizes[0] < 5000


def test_what_does_not_look_back_keeps_nothing() -> None:
    simulator, contexts = truss(), rows(0)
    found = simulator.follow(contexts)
    assert (found.readings == simulator.predict(contexts)).all()
    assert found.memory.to_bytes() == b'{"effects":{}}'


@pytest.mark.parametrize(
    ("effect", "why"),
    [
        ({**DRIFT, "onset": 1.0, "profile": "ramp"}, "ramp without an end"),
        ({**CLOCK, "time": -1.0}, "early"),
        ({**CLOCK, "time": {"context": "air"}}, "must not follow a context"),
    ],
)
def test_what_cannot_be_followed(effect: dict[str, Any], why: str) -> None:
    simulator = truss(it=effect)
    assert why in simulator.hindrance
    with pytest.raises(InputError, match="effect 'it'"):
        simulator.follow(rows(0))


def test_a_zero_of_the_logger_is_not_followed() -> None:
    model = truss().model
    tared = {name: one.model_copy(update={"zero": (0, 9)}) for name, one in model.sensors.items()}
    with pytest.raises(InputError, match="its zero is a mean"):
        Simulator(model.with_sensors(tared)).follow(rows(0))


def test_a_kind_that_remembers_and_keeps_nothing_is_not_followed() -> None:
    class Inertia(Effect):
        kind: str = "inertia_of_a_test"
        remembers = True

    try:
        assert "does not say what it keeps" in truss(it={"kind": "inertia_of_a_test"}).hindrance
    finally:
        del Effect.vocabulary["inertia_of_a_test"]


def test_the_memory_of_other_effects_is_refused() -> None:
    memory = truss(drift=DRIFT).follow(rows(0)).memory
    with pytest.raises(InputError, match=r"\['drift'\].*\['lag'\]"):
        truss(lag=LAG).follow(rows(0), memory)
    for content in (b"", b"{}", b'{"effects":{"drift":[1]}}', b'{"effects":{},"friction":{}}'):
        with pytest.raises(InputError, match="no memory"):
            Memory.from_bytes(content)


def test_a_memory_is_not_changed_by_what_follows_it() -> None:
    simulator = truss(**ALONE)
    memory = simulator.follow(rows(0)).memory
    before = memory.to_bytes()
    later = rows(2) | {"time": rows(2)["time"] + 1e7}
    first, again = (simulator.follow(later, memory) for _ in range(2))
    assert memory.to_bytes() == before
    assert (first.readings == again.readings).all()
