"""The bridges a case may stand on, by name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .draft import Bridge
from .footbridge import footbridge
from .pratt import pratt
from .warren import warren

BRIDGES: dict[str, Callable[[np.random.Generator], Bridge]] = {
    "pratt": pratt,
    "warren": warren,
    "footbridge": footbridge,
}
