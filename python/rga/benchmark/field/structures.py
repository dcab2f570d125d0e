"""The structures that a case of the field may stand on, by name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .jib import jib
from .k_truss import k_truss
from .mast import mast
from .portal import portal
from .roof import roof
from .structure import Structure

STRUCTURES: dict[str, Callable[[np.random.Generator], Structure]] = {
    "mast": mast,
    "roof": roof,
    "K truss": k_truss,
    "portal": portal,
    "jib": jib,
}
