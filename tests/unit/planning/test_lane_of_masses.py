"""Where the loads of a model show no lane, its masses do."""

import numpy as np

from independent.modal_bridge import bridge
from rga.experiments.defaults import PARKED, usual_truck
from rga.experiments.truck import lane_of, lane_of_masses
from rga.model import read_model
from rga.model.mass_budget import mass_budget

DECK = tuple(tuple(f"b{at}{side}" for at in range(7)) for side in "ns")


def test_chains_of_nodes_that_carry_a_mass_are_a_lane() -> None:
    model = read_model(bridge(), "bridge")
    assert lane_of(model) is None
    lane = lane_of_masses(model)
    assert lane is not None
    assert (lane.paths, lane.shares, lane.driven) == (DECK, (0.5, 0.5), False)


def test_nodes_of_a_group_that_carries_a_mass_are_a_lane() -> None:
    content = bridge()
    content["masses"] = {"deck": {"group": ["bottom n", "bottom s"], "per_length": 500.0}}
    lane = lane_of_masses(read_model(content, "bridge"))
    assert lane is not None
    assert lane.paths == DECK
    content["masses"] = {}
    assert lane_of_masses(read_model(content, "bridge")) is None


def test_where_nothing_loads_the_structure_a_truck_is_a_share_of_it() -> None:
    model = read_model(bridge(), "bridge")
    lane = lane_of_masses(model)
    assert lane is not None
    truck = usual_truck(model, lane)
    mass = sum(part.total for part in mass_budget(model))
    np.testing.assert_allclose(sum(truck.loads), PARKED * mass * 9.80665 / 1e3, rtol=0.1)
