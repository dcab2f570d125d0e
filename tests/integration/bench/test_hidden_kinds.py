"""Every kind that is hidden shows on every bridge that can have it."""

from __future__ import annotations

import json

import numpy as np
import pytest

from rga_bench.synthetic import BRIDGES, KINDS, draw_case
from rga_bench.synthetic.hidden.catalogue import HIDDEN, fits
from rga_bench.synthetic.noise import stream

PAIRS = [
    (bridge, kind)
    for bridge in BRIDGES
    for kind in KINDS
    if fits(kind, BRIDGES[bridge](stream(1, "bridge")))
]


@pytest.mark.parametrize(("bridge", "kind"), PAIRS)
def test_every_kind_shows_on_every_bridge_that_can_have_it(bridge: str, kind: str) -> None:
    case = draw_case(5, bridge=bridge, kind=kind, rows=150)
    truth = case.truth
    assert (truth["kind"], truth["bridge"]) == (kind, bridge)
    assert (truth["d_prime"] > 3.0) == (kind != "null")
    assert truth["reality"] == "frame" if kind == "joint_rigidity" else True
    json.dumps(truth, allow_nan=False)
    if kind != "null" and HIDDEN[kind].parameter:
        assert np.isfinite(truth["value"])
        assert truth["parameter"]
    for channel in case.channels.values():
        assert channel.shape == case.time.shape
        assert np.isnan(channel).mean() < 0.1
