"""Deflections and strains over the ranges that no structure in use has."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.simulation.stresses import AXIS, Stresses

#: share of the size of the structure by which it may move in use, and beyond which it is another
MOST, FAR = 0.01, 0.1
#: strain beyond which hardly a material is elastic [m/m]
ELASTIC = 0.02


def deformations(over: OverRanges) -> Iterator[Finding]:
    """Deflections beyond a hundredth of the size, strains beyond 2 %, stresses beyond yield."""
    model, found = over.model, over.results if over.model.members else None
    if found is None:
        return
    points = np.array(list(model.nodes.values()), dtype=float)
    size = float(np.ptp(points, axis=0).max())
    moved = np.linalg.norm(found.displacements[..., :3], axis=2)
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
    yield from _stresses(over, found.stresses)


def _stresses(over: OverRanges, stresses: Stresses) -> Iterator[Finding]:
    model = over.model
    yields: dict[str, tuple[float, str, int]] = {}
    stretched: dict[str, tuple[float, int]] = {}
    for name, fibres in stresses.limits().items():
        material = model.materials[model.members[name].material]
        for fibre, limits in fibres.items():
            of_rows = np.abs(limits).max(axis=1)
            row, size = int(np.argmax(of_rows)), float(of_rows.max())
            if size > ELASTIC * material.E:
                stretched[name] = max(stretched.get(name, (0.0, 0)), (size / material.E, row))
            if material.yield_strength is not None and size > material.yield_strength:
                used = size / material.yield_strength
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
        at = "" if fibre == AXIS else f" at fibre {fibre!r}"
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
