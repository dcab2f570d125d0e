"""Deflections and strains over the ranges that no structure in use has."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges

#: share of the size of the structure by which it may move in use, and beyond which it is another
MOST, FAR = 0.01, 0.1
#: strain beyond which hardly a material is elastic [m/m]
ELASTIC = 0.02


def deformations(over: OverRanges) -> Iterator[Finding]:
    """Deflections beyond a hundredth of the size, strains beyond 2 %, stresses beyond yield."""
    model, motions = over.model, over.motions
    points = np.array(list(model.nodes.values()), dtype=float).reshape(-1, 3)
    if not len(motions) or not len(points) or not model.members:
        return
    size = float(np.ptp(points, axis=0).max())
    moved = np.linalg.norm(motions, axis=2)
    row, node = np.unravel_index(int(np.argmax(moved)), moved.shape)
    largest = float(moved[row, node])
    if largest > MOST * size:
        beyond = largest > FAR * size and model.analysis.geometry == "linear"
        yield Finding(
            "warning",
            parts("node", [list(model.nodes)[node]]),
            f"at {_at(over, int(row))} it moves by {largest:.3g} m, {largest / size:.2g} of the "
            "size of the structure" + (": beyond what a linear analysis tells" if beyond else ""),
            "check units of loads, E, A and I, and the ranges of the contexts",
        )
    yield from _strains(over)


def _strains(over: OverRanges) -> Iterator[Finding]:
    model = over.model
    yields: dict[str, tuple[float, str, int]] = {}
    stretched: dict[str, tuple[float, int]] = {}
    for (name, fibre), strain in over.strains.items():
        row = int(np.argmax(strain))
        if strain[row] > ELASTIC:
            stretched[name] = max(stretched.get(name, (0.0, 0)), (float(strain[row]), row))
        material = model.materials[model.members[name].material]
        if material.yield_strength is not None:
            used = float(material.E * strain[row] / material.yield_strength)
            if used > 1:
                yields[name] = max(yields.get(name, (0.0, "", 0)), (used, fibre, row))
    if stretched:
        worst = max(stretched, key=lambda name: stretched[name][0])
        share, row = stretched[worst]
        yield Finding(
            "warning",
            parts("member", sorted(stretched)),
            f"at {_at(over, row)} {worst!r} is strained by {100 * share:.3g} %",
            "check units of loads, E, A and I, and the ranges of the contexts",
        )
    if yields:
        worst = max(yields, key=lambda name: yields[name][0])
        used, fibre, row = yields[worst]
        at = "" if fibre == "axis" else f" at fibre {fibre!r}"
        yield Finding(
            "warning",
            parts("member", sorted(yields)),
            f"at {_at(over, row)} the stress of {worst!r}{at} is {used:.3g} times the yield "
            "strength",
            "check units of loads and of yield_strength [Pa], and the ranges of the contexts",
        )


def _at(over: OverRanges, row: int) -> str:
    """The contexts of a row in words."""
    units = {name: one.unit for name, one in over.model.context.items()}
    said = [f"{name} {over.contexts[name][row]:.4g} {unit}" for name, unit in units.items()]
    return ", ".join(said[:4]) or "the loads given"
