"""Bases between a pin and a clamp."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rga.model.bending import bending_at
from rga.model.parameter import Positive, listed
from rga.model.schema import Model

#: A base between a pin and a clamp, over the sum of EI/L of the members that bend with it, as the
#: median and the spread of a log-normal whose 90 % range is that of semi-rigid joints: below 30 a
#: column base is not rigid in a frame that sways, below 0.5 a joint is as good as a pin
#: (EN 1993-1-8, 5.2.2.5). A base that was meant as a pin lies in it too: a tenth of the stiffness
#: of the column, 0.4, is what BS 5950-1, 5.1.3 lets one count on there.
PINNED, RIGID = 0.5, 30.0
BASE = Positive(float(np.sqrt(PINNED * RIGID)), float(np.log(RIGID / PINNED) / (2 * 1.645)))
BASE_WORDS = (
    f"of a rotation {BASE} times the EI/L of the frame members that bend with it, between a pin "
    "and a clamp by EN 1993-1-8, 5.2.2.5"
)


def base_stiffness(model: Model, place: Mapping[str, Any]) -> Positive:
    """What is known of the rotational stiffness of a support [N m/rad]."""
    nodes = [model.supports[name].node for name in listed(place["support"])]
    mean = float(np.mean([bending_at(model, node, place["dof"]) for node in nodes]))
    return BASE.times(mean)
