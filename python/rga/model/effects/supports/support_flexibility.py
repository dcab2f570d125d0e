"""Supports that give way."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.scales import mean_axial_stiffness
from rga.model.effects.supports.bases import BASE_WORDS, base_stiffness
from rga.model.effects.supports.directions import (
    Direction,
    MaybeNodes,
    MaybeSupports,
    check_sprung_or_supported,
    directions,
    rotations,
    sprung_nodes,
    sprung_stiffness,
    supported,
    turns,
)
from rga.model.parameter import Parameter, Positive, Prior, Value, listed
from rga.model.schema import DOFS, Model
from rga.model.structure import Structure

ALONG = Positive(0.3, 1.5)
#: behind a spring of the model: as stiff as that, or a few times softer or stiffer
BEHIND = Positive(1.0, 1.5)


class SupportFlexibility(Effect):
    """A stiffness [N/m or N m/rad] in place of a rigid direction of a support.

    Soft ground, or a column base that turns; two in one direction give way one behind the other. A
    rotation is proposed where a frame member bends with it. Where a spring of the model holds a
    node, the place is that node, and the stiffness stands behind that of the spring.
    """

    kind: Literal["support_flexibility"] = "support_flexibility"
    action = Action(
        inspect=(
            "bearing, bedding and masonry at {place}: loose anchor bolts, cracked mortar, soft "
            "ground"
        ),
        check="any displacement sensor whose reference stands on the same pier",
        test="{load}, over the support {place}, with its movement measured against firm ground",
    )
    usual = (
        f"stiffness {ALONG} times the mean EA/L of the members, behind a spring of the model "
        f"{BEHIND} times its own: judgements; {BASE_WORDS}"
    )
    structural = True
    support: MaybeSupports = None
    node: MaybeNodes = None
    dof: Direction
    stiffness: Annotated[Value, Parameter("N/m", float("inf"), least=0.0)] = float("inf")

    def check(self, model: Model) -> None:
        check_sprung_or_supported(self.kind, self.support, self.node, self.dof, model)
        for name in listed(self.support):
            if self.dof not in model.supports[name].fixed:
                raise ValueError(f"support {name!r} leaves {self.dof} free: name a held direction")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=True)
        yield from rotations(model, held=True)
        yield from sprung_nodes(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        along = ALONG.times(mean_axial_stiffness(model))
        if "node" in place:
            return {"stiffness": BEHIND.times(sprung_stiffness(model, place))}
        return {"stiffness": base_stiffness(model, place) if turns(place["dof"]) else along}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        if np.isinf(value["stiffness"]):
            return
        nodes = [structure.nodes[name] for name in listed(self.node)]
        for node in [*supported(structure, self.support), *nodes]:
            _give_way(structure, node, DOFS.index(self.dof), value["stiffness"])


def _give_way(structure: Structure, node: int, dof: int, stiffness: float) -> None:
    """A spring in place of a rigid direction, or behind one that stands there already."""
    arrays = structure.arrays
    if arrays["fixed"][node, dof]:
        arrays["fixed"][node, dof] = False
        structure.add_spring(node, -1, dof, stiffness)
        return
    own = (arrays["spring_node"] == [node, -1]).all(axis=1) & (arrays["spring_dof"] == dof)
    known = arrays["spring_stiffness"][own]
    together = known * stiffness / np.maximum(known + stiffness, np.finfo(float).tiny)
    arrays["spring_stiffness"][own] = together
