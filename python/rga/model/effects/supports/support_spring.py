"""Supports that hold more than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

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
    only_free,
    rotations,
    sprung_nodes,
    sprung_stiffness,
    supported,
    turns,
)
from rga.model.parameter import Parameter, Positive, Prior, Value, listed
from rga.model.schema import DOFS, Model
from rga.model.structure import Structure

ALONG = Positive(0.1, 2.0)
#: beside a spring of the model: as stiff as that, or a few times softer or stiffer
BESIDE = Positive(1.0, 1.5)


class SupportSpring(Effect):
    """A spring [N/m or N m/rad] on a direction that the support leaves free.

    A frozen bearing, or a base that was taken as a pin and holds a moment. A rotation is proposed
    where a frame member bends with it. Where a spring of the model holds a node, the place is that
    node, and the stiffness stands beside that of the spring.
    """

    kind: Literal["support_spring"] = "support_spring"
    action = Action(
        inspect=(
            "the bearing {place}: rust, dirt, seized rollers, a worn sliding face, ballast "
            "against its plate"
        ),
        check="movement marks of the bearing over a day of changing temperature",
        test=(
            "measure the movement of the bearing and the strain of the chord beside it over a "
            "warm day, or jack it free and repeat"
        ),
    )
    may_let_go = True
    usual = (
        f"stiffness {ALONG} times the mean EA/L of the members, beside a spring of the model "
        f"{BESIDE} times its own: judgements; {BASE_WORDS}"
    )
    structural = True
    support: MaybeSupports = None
    node: MaybeNodes = None
    dof: Direction
    stiffness: Annotated[Value, Parameter("N/m", 0.0, least=0.0)] = 0.0

    def check(self, model: Model) -> None:
        check_sprung_or_supported(self.kind, self.support, self.node, self.dof, model)
        only_free(model, self.support, self.dof)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=False)
        yield from rotations(model, held=False)
        yield from sprung_nodes(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        if "node" in place:
            return {"stiffness": BESIDE.times(sprung_stiffness(model, place))}
        along = ALONG.times(mean_axial_stiffness(model))
        return {"stiffness": base_stiffness(model, place) if turns(place["dof"]) else along}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        nodes = [structure.nodes[name] for name in listed(self.node)]
        for node in [*supported(structure, self.support), *nodes]:
            if value["stiffness"] > 0:
                structure.add_spring(node, -1, DOFS.index(self.dof), value["stiffness"])
