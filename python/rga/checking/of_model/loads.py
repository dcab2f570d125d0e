"""Loads that load nothing."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import FloatArray
from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.errors import InputError
from rga.model.effects.loads.axle_load import AxleLoad
from rga.model.structure import Load, Structure


def loads(over: OverRanges) -> Iterator[Finding]:
    """Loads without a force, with a factor of 0, or on supports alone."""
    model = over.model
    if not any(effect.overrides("loads") for effect in model.effects.values()):
        what = "no load or temperature acts on it"
        yield Finding("note", f"model {model.name!r}", what, "add the effects that do")
        return
    try:
        structure, values = over.structure, over.simulator.resolve(over.contexts)
        given = {
            name: effect.loads(structure, values[name], values)
            for name, effect in model.effects.items()
            if effect.is_load
        }
    except InputError:
        return  # told by the simulation
    for name, own in given.items():
        if fault := _fault(structure, own, isinstance(model.effects[name], AxleLoad)):
            yield Finding("warning", parts("effect", [name]), *fault)


def _fault(structure: Structure, own: list[Load], comes_and_goes: bool) -> tuple[str, str] | None:
    """What makes a load none, and the remedy."""
    if not any(_forces(load).any() or load.spread for load in own):
        return "it has no force", "give it one [N], or take it out"
    if not comes_and_goes and not any(np.any(load.coefficient) for load in own):
        return "its factor is 0 over all ranges", "give another factor, or take it out"
    fixed = structure.arrays["fixed"]
    for load in own:
        numbers = list(load.forces)
        if load.spread or (_forces(load)[~fixed[numbers]]).any():
            return None
    return (
        "all its forces act on directions that supports or the plane hold: nothing feels them",
        "check its nodes, its directions and the supports",
    )


def _forces(load: Load) -> FloatArray:
    """Forces and moments at its nodes, float[nodes, 6]."""
    return np.array(list(load.forces.values()), dtype=float).reshape(-1, 6)
