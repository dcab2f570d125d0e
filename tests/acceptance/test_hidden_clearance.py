"""Slip in joints and stops at bearings: two ways to simulate them agree, and hidden ones are found.

The readings come from physics of their own (rga_bench.synthetic), which goes force by force where
the simulator goes by Newton steps on elongations.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rga.findings import Findings
from rga.model import read_model
from rga.simulation import Simulator
from rga_bench.synthetic import Case, draw_case
from rga_bench.synthetic.bridges.catalogue import BRIDGES
from rga_bench.synthetic.contexts import courses
from rga_bench.synthetic.hidden.catalogue import HIDDEN
from rga_bench.synthetic.hidden.effect import EffectSetting
from rga_bench.synthetic.noise import stream
from rga_bench.synthetic.physics.response import respond
from rga_bench.synthetic.physics.world import World

KINDS = ("joint_slip", "support_gap")


@pytest.mark.parametrize("name", BRIDGES)
@pytest.mark.parametrize("kind", KINDS)
def test_forces_and_elongations_lead_to_the_same_readings(name: str, kind: str) -> None:
    bridge = BRIDGES[name](stream(3, "bridge"))
    time, contexts = courses(bridge, stream(3, "contexts"), 40)
    setting = EffectSetting(bridge, float(time[-1]), {})
    for seed in (0, 1):
        span = HIDDEN[kind].draw(setting, np.random.default_rng(seed))
        if kind == "support_gap":
            span = replace(span, fixed={"gap": 1e-4})
        value = span.at(0.8)
        assert value is not None
        world = World.of(bridge.model)
        plain = respond(world, contexts, time)[0]
        HIDDEN[kind].act(world, span, value)
        expected = respond(world, contexts, time)[0]
        own = {"kind": kind, **span.place, **span.fixed, HIDDEN[kind].parameter: value}
        content = {**bridge.model, "effects": {**bridge.model["effects"], "own": own}}
        found = Simulator(read_model(content, name)).predict({**contexts, "time": time})
        assert np.abs(expected - plain).max() > 1.0
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8)


def drawn(kind: str, hidden: str) -> Case:
    """A case of the footbridge in which `hidden` is, or nothing (`null`)."""
    seed, rows = {"joint_slip": (2015, 100), "support_gap": (2020, 60)}[kind]
    return draw_case(seed, bridge="footbridge", kind=hidden, reality="truss", rows=rows)


@pytest.mark.parametrize("kind", KINDS)
def test_a_hidden_one_is_named(kind: str, diagnosed: Callable[[Case], Findings]) -> None:
    case = drawn(kind, kind)
    truth = case.truth
    assert truth["d_prime"] > 15
    (cause,) = diagnosed(case).causes
    assert cause.effect["kind"] == kind
    assert {name: cause.effect[name] for name in truth["place"]} == truth["place"]
    low, high = cause.effect[truth["parameter"]]["ci90"]
    assert low / 1.5 < truth["value"] < 1.5 * high


@pytest.mark.parametrize("kind", KINDS)
def test_its_null_twin_names_nothing(kind: str, diagnosed: Callable[[Case], Findings]) -> None:
    case = drawn(kind, "null")
    assert case.truth["d_prime"] == 0
    assert not diagnosed(case).causes
