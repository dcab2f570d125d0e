"""The bridges a case may stand on, by name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rga_bench.synthetic.bridges.footbridge import footbridge
from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.bridges.pratt import pratt
from rga_bench.synthetic.bridges.warren import warren

BRIDGES: dict[str, Callable[[np.random.Generator], Bridge]] = {
    "pratt": pratt,
    "warren": warren,
    "footbridge": footbridge,
}
