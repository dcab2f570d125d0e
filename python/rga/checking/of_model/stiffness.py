"""Members whose stiffness is nothing, or out of all proportion to that of others."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rga.arrays import BoolArray, FloatArray
from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.model.axes import local_axes
from rga.model.bending import normal_of
from rga.model.structure import build_structure

#: ratio of the largest to the smallest stiffness of a kind, from which on one of them is odd
RATIO = 1e6
#: length over radius of gyration, from which on a member is a thread
SLENDER = 1000.0
#: share of an axis that counts as none
ACROSS = 1e-6


def stiffness(over: OverRanges) -> Iterator[Finding]:
    """Bending and twist without stiffness, ratios of EA and EI of a million, threads."""
    model = over.model
    if not model.members:
        return
    arrays = build_structure(model).arrays
    names = np.array(list(model.members), dtype=object)
    frame = arrays["frame"]
    lengths, axes = local_axes(arrays, np.arange(len(names)))
    normal = normal_of(model)
    for key, axis in (("Iy", 1), ("Iz", 2), ("J", 0)):
        inertia = {"Iy": arrays["Iy"], "Iz": arrays["Iz"], "J": arrays["J"]}[key]
        # In a plane nothing turns but about its normal.
        turns = np.ones(len(names)) if normal is None else np.abs(axes[:, axis] @ normal)
        without = frame & (inertia == 0) & (turns > ACROSS)
        if without.any():
            sections = dict.fromkeys(model.members[name].section for name in names[without])
            yield Finding(
                "warning",
                parts("section", sections),
                f"{key} is 0: the frame {parts('member', names[without])} "
                f"{'do' if without.sum() > 1 else 'does'} not resist "
                f"{'twist' if key == 'J' else 'bending'} by it",
                f"give {key} [m4], or make truss members of them",
            )
        if key != "J":
            bends = frame & (inertia > 0)
            yield from _far_apart(f"E {key}", "N m2", arrays["E"] * inertia, bends, names)
    whole = np.ones(len(names), dtype=bool)
    yield from _far_apart("EA", "N", arrays["E"] * arrays["A"], whole, names)
    radius = np.sqrt(np.minimum(*_known(arrays["Iy"], arrays["Iz"])) / arrays["A"])
    thread = np.isfinite(radius) & (lengths > SLENDER * radius)
    if thread.any():
        worst = int(np.argmax(np.where(thread, lengths / radius, 0)))
        yield Finding(
            "note",
            parts("member", names[thread]),
            f"length over radius of gyration is {lengths[worst] / radius[worst]:.3g} "
            f"({names[worst]!r})",
            "check A, Iy, Iz and the coordinates: such a member carries no compression",
        )


def _known(*inertias: FloatArray) -> list[FloatArray]:
    """Second moments, infinite where none is given."""
    return [np.where(one > 0, one, np.inf) for one in inertias]


def _far_apart(
    what: str, unit: str, sizes: FloatArray, of: BoolArray, names: NDArray[np.object_]
) -> Iterator[Finding]:
    if not of.any():
        return
    low, high = (int(np.flatnonzero(of)[pick(sizes[of])]) for pick in (np.argmin, np.argmax))
    if sizes[high] > RATIO * sizes[low]:
        yield Finding(
            "warning",
            parts("member", [names[low], names[high]]),
            f"their {what} are {sizes[low]:.3g} and {sizes[high]:.3g} {unit}, a factor of "
            f"{sizes[high] / sizes[low]:.1g}",
            "check units of sections and materials; make rigid what is meant so by a tie",
        )
