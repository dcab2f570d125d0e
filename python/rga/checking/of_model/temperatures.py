"""Temperatures that warm a part of the structure only, or do nothing, or far too much."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.model.effects.temperature.temperature import Temperature

#: change of temperature that no structure sees [K]
MOST = 150.0


def temperatures(over: OverRanges) -> Iterator[Finding]:
    """Members that no temperature warms, alpha of 0 beside one, and changes of hundreds of K."""
    model = over.model
    effects = {n: one for n, one in model.effects.items() if isinstance(one, Temperature)}
    if not effects:
        return
    warm = {
        member
        for effect in effects.values()
        for group in effect.groups
        for member in model.groups[group]
    }
    cold = [name for name in model.members if name not in warm]
    if cold:
        yield Finding(
            "note",
            parts("member", cold),
            f"no group of {parts('effect', effects)} warms it, while others change with the "
            "temperature",
            "put it into a group of the effect, unless its temperature stays",
        )
    rigid = dict.fromkeys(
        model.members[name].material
        for name in model.members
        if name in warm and not model.materials[model.members[name].material].alpha
    )
    if rigid:
        yield Finding(
            "warning",
            parts("material", rigid),
            "alpha is 0: temperature does nothing to its members",
            "give alpha [1/K], such as 1.2e-5 for steel",
        )
    resolved = over.simulator.resolve(over.contexts)
    for name, effect in effects.items():
        kelvin = np.abs(resolved[name]["delta"]).max() * max(
            map(abs, effect.groups.values()), default=0
        )
        if kelvin > MOST:
            yield Finding(
                "warning",
                parts("effect", [name]),
                f"over the ranges it changes temperatures by up to {kelvin:.3g} K",
                "check the unit of its context (degC, K), 'minus', 'times' and the groups' kelvin",
            )
