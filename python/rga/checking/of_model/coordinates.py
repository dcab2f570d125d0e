"""Coordinates that look as if they were given in other units."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding
from rga.checking.over_ranges import OverRanges

#: length of the middle one of all members [m]
LONGEST, SHORTEST = 150.0, 0.02
#: lengths that are usual
USUAL = (0.5, 30.0)
UNITS = {"mm": 1e-3, "cm": 1e-2, "ft": 0.3048, "in": 0.0254}


def coordinates(over: OverRanges) -> Iterator[Finding]:
    """Members of hundreds of metres, or of millimetres."""
    nodes, members = over.model.nodes, over.model.members.values()
    if not members:
        return
    ends = np.array([[nodes[node] for node in member.nodes] for member in members])
    typical = float(np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))
    if SHORTEST <= typical <= LONGEST:
        return
    of = next((name for name, size in UNITS.items() if USUAL[0] <= typical * size <= USUAL[1]), "")
    remedy = f"it would be usual in {of}: multiply all coordinates by {UNITS[of]:g}" if of else ""
    yield Finding(
        "warning",
        "nodes",
        f"the middle one of all members is {typical:.3g} m long",
        remedy or "give coordinates in m",
    )
