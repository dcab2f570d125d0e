"""Rows that differ in stiffnesses alone are solved side by side, all others one by one."""

from typing import Any

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.model import Model, read_model
from rga.simulation.modal.simulator import ModalSimulator
from rga.simulation.modal.structures import ModalStructures
from unit.simulation.modal.test_simulator import MODES, PARTS, SENSORS, beam, shape

#: a spring that is there at any temperature
STIFFER = {
    "kind": "support_spring",
    "support": "n0",
    "dof": "uy",
    "stiffness": {"context": "cold", "times": 4e7, "minus": -0.1},
}
#: a mode moves along its own direction alone: rounding along the other has a shape as well
STILL = {name: 0.0 for way in "VL" for name in shape(way, 1)}
ACROSS = {name: one | {"shape": STILL | one["shape"]} for name, one in MODES.items()}
#: effects on masses, with the context that drives each; the last two are small
ON_MASSES: dict[str, tuple[str, dict[str, Any]]] = {
    "layer": ("snow", {"kind": "added_mass", "group": "deck", "per_length": {"times": 90}}),
    "rain": ("wet", {"kind": "mass_factor", "material": "steel", "factor": {"minus": -1}}),
    "crate": ("snow", {"kind": "added_mass", "node": "n3", "mass": {"times": 0.01}}),
    "grime": ("dust", {"kind": "mass_factor", "material": "steel", "factor": {"minus": -1}}),
}
RANGES = {"cold": (0.0, 1.0), "snow": (0.0, 1.0), "wet": (0.0, 0.1), "dust": (0.0, 1e-7)}


def model(**effects: dict[str, Any]) -> Model:
    content = beam(modes=ACROSS, sensors=SENSORS)
    content["effects"] = {"bearings": STIFFER, **effects}
    ranges = RANGES | {"at": (-50.0, 50.0)}
    content["context"] = {name: {"unit": "-", "range": one} for name, one in ranges.items()}
    return read_model(content, "a test")


def driven(context: str, effect: dict[str, Any]) -> dict[str, Any]:
    parameter = {
        name: one | {"context": context} for name, one in effect.items() if isinstance(one, dict)
    }
    return effect | parameter


def one_by_one(simulator: ModalSimulator, contexts: dict[str, FloatArray]) -> FloatArray:
    rows = range(len(contexts["cold"]))
    each = [{name: column[row] for name, column in contexts.items()} for row in rows]
    return np.vstack([simulator.predict(one) for one in each])


def held(together: FloatArray, alone: FloatArray) -> None:
    np.testing.assert_allclose(together[:, :2], alone[:, :2], rtol=1e-9)
    np.testing.assert_allclose(together, alone, rtol=1e-5)


def drawn(seed: int, rows: int) -> dict[str, FloatArray]:
    """Contexts that lie anywhere, now and then at an end, some of them still."""
    draw = np.random.default_rng(seed)
    found = {}
    for name, (low, high) in RANGES.items():
        column = draw.uniform(low, high, rows)
        column[draw.random(rows) < 0.2] = draw.choice([low, high])
        found[name] = np.full(rows, column[0]) if draw.random() < 0.3 else column
    return found | {"cold": draw.uniform(0.0, 1.0, rows), "at": np.full(rows, 50.0)}


@pytest.mark.parametrize("seed", range(3))
def test_side_by_side_they_read_what_each_reads_by_itself(seed: int) -> None:
    contexts = drawn(seed, 41)
    own = model()
    simulator, samples = ModalSimulator(own), ModalStructures(own).samples(contexts)
    assert samples is not None
    assert len(samples.factors) == 41
    together = simulator.predict(contexts)
    held(together, one_by_one(simulator, contexts))
    assert np.ptp(together[:, 1]) > 0.005 * together[0, 1]


@pytest.mark.parametrize("seed", range(12))
def test_masses_count_wherever_they_vary(seed: int) -> None:
    draw, contexts = np.random.default_rng([seed, 1]), drawn(seed, 23)
    chosen = [name for name in ON_MASSES if draw.random() < 0.5]
    own = model(**{name: driven(*ON_MASSES[name]) for name in chosen})
    simulator = ModalSimulator(own)
    held(simulator.predict(contexts), one_by_one(simulator, contexts))
    vary = any(np.ptp(contexts[ON_MASSES[name][0]]) > 0 for name in chosen)
    assert (ModalStructures(own).samples(contexts) is None) == vary


@pytest.mark.parametrize("passing", [3, 77, 141, 200, 298])
def test_a_truck_that_stands_on_it_in_one_row_of_many_has_its_mass_there(passing: int) -> None:
    nodes = [f"n{at}" for at in range(PARTS + 1)]
    truck = {"kind": "axle_load", "path": nodes, "forces": [2e5], "offsets": [0.0]}
    own = model(truck=truck | {"position": {"context": "at"}, "inertia": True})
    at = np.where(np.arange(300) % 2, -40.0, 40.0)
    at[passing] = 10.0
    contexts = {"cold": np.linspace(0.0, 1.0, 300), "at": at}
    contexts |= {name: np.zeros(300) for name in ("snow", "wet", "dust")}
    found = ModalSimulator(own).predict(contexts)[:, 0]
    beside = np.delete(found, passing)
    assert np.ptp(beside) < 1e-6 * beside[0]
    assert found[passing] < 0.8 * beside[0]
