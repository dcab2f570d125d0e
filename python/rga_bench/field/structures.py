"""The structures that a case of the field may stand on, by name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rga_bench.field.jib import jib
from rga_bench.field.k_truss import k_truss
from rga_bench.field.mast import mast
from rga_bench.field.portal import portal
from rga_bench.field.roof import roof
from rga_bench.field.structure import FieldStructure

STRUCTURES: dict[str, Callable[[np.random.Generator], FieldStructure]] = {
    "mast": mast,
    "roof": roof,
    "K truss": k_truss,
    "portal": portal,
    "jib": jib,
}
