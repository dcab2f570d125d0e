"""Loads that keep to one side."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.loads.targets import Effects, check_target, load_names, together
from rga.model.parameter import Normal, Parameter, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Load, Structure

USUAL = Normal(0.0, 0.1)


class LoadEccentricity(Effect):
    """Loads shifted sideways: at +y nodes times (1 + 2 share), at -y nodes (1 - 2 share).

    A load along a member is shifted as the mean of the member's two nodes.
    """

    kind: Literal["load_eccentricity"] = "load_eccentricity"
    action = Action(
        inspect="which lane or side the traffic or crowd keeps to",
        check="the place of {place} across the structure",
        test="the same known load on either side",
    )
    usual = f"share {USUAL}: a judgement"
    loads_by_geometry = True
    effect: Effects
    share: Annotated[Value, Parameter("-", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        check_target(self, self.effect, model, "factor")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if np.ptp([point[1] for point in model.nodes.values()]) > 0:
            yield from together(model, list(load_names(model)))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"share": USUAL}

    def change_loads(
        self, loads: dict[str, list[Load]], structure: Structure, values: Values
    ) -> None:
        for name in listed(self.effect):
            given = loads[name]
            patterns = [one for load in given for one in load.pattern]
            shifted = structure.once_for_geometry(partial(_shifted, structure, given), *patterns)
            loads[name] = [
                *given,
                *(
                    to_side.times(2 * values["share"] * load.coefficient)
                    for to_side, load in zip(shifted, given, strict=True)
                ),
            ]


def _shifted(structure: Structure, loads: list[Load]) -> list[Load]:
    """Loads that are full at the +y side of the structure and turned round at the -y side."""
    y = structure.arrays["coordinates"][:, 1]
    side = np.sign(np.round(y - (y.min() + y.max()) / 2, 9))
    of_member = side[structure.arrays["ends"]].mean(axis=1)
    return [
        replace(
            load,
            forces={node: side[node] * force for node, force in load.forces.items()},
            spread=[
                (member, *along, of_member[member] * start, of_member[member] * end)
                for member, *along, start, end in load.spread
            ],
        )
        for load in loads
    ]
