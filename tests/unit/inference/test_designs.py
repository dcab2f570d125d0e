"""Designs of contexts: boxes, both directions of travel, equal bits."""

import numpy as np
import pytest
import torch

from crossed_truss import LATENT, crossed_truss
from rga.errors import InputError
from rga.inference.networks.design_samples import design
from rga.inference.networks.travel_direction import EitherWay
from rga.model.schema import Model
from rga.simulation import Simulator


@pytest.fixture(scope="module")
def truss() -> Model:
    return crossed_truss(both_ways=True)


@pytest.fixture(scope="module")
def forwards() -> Model:
    return crossed_truss(both_ways=False)


def test_a_design_holds_both_directions(truss: Model, forwards: Model) -> None:
    drawn = design(truss, 64, latent=LATENT, seed=1, box={"crowd": (5.0, 6.0)})
    assert drawn.reversed.sum() == 32
    crowd, _, cart = drawn.contexts.T
    assert crowd.min() >= 5
    assert crowd.max() <= 6
    simulator = Simulator(truss)
    for chosen, sign in ((~drawn.reversed, 1), (drawn.reversed, -1)):
        order = np.flatnonzero(chosen)[np.argsort(sign * cart[chosen])]
        table = dict(zip(truss.context, drawn.contexts[order].T, strict=True))
        assert np.array_equal(drawn.readings[order], simulator.predict(table))
    again = design(truss, 64, latent=LATENT, seed=1, box={"crowd": (5.0, 6.0)})
    assert again.readings.tobytes() == drawn.readings.tobytes()
    for model, latent in ((forwards, LATENT), (truss, ("crowd",))):
        assert not design(model, 64, latent=latent, seed=1).reversed.any()
    with pytest.raises(InputError, match="no context 'snow'"):
        design(truss, 64, latent=LATENT, seed=1, box={"snow": (0.0, 1.0)})


def test_either_way_does_not_hang_on_the_order_of_rows(truss: Model) -> None:
    drawn = design(truss, 64, latent=LATENT, seed=1)
    both = EitherWay(Simulator(truss).as_torch(), 2)(torch.from_numpy(drawn.contexts)).numpy()
    found = np.where(drawn.reversed[:, None], both[1], both[0])
    assert np.allclose(found, drawn.readings, atol=1e-9)
    assert not np.allclose(both[0], both[1])
