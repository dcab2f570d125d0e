"""Supports that meet a stop."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.scales import mean_axial_stiffness
from rga.model.effects.supports.directions import (
    Direction,
    Supports,
    directions,
    only_free,
    supported,
)
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import DOFS, Model
from rga.model.structure import Law, Structure

GAP = Positive(2e-3, 1.0, trials=(-1.0, 0.0, 1.0))
STOP = Positive(0.1, 2.0, trials=(-1.0, 1.0))


class SupportGap(Effect):
    """A stop on a free direction: a stiffness [N/m] once the support has moved by a gap [m]."""

    kind: Literal["support_gap"] = "support_gap"
    action = Action(
        inspect=(
            "the bearing {place}: the play at its stop, packing, uplift, a plate that no longer "
            "bears"
        ),
        check="the gap with a feeler gauge, unloaded and cold",
        test=(
            "{load}, near {place}, with its movement measured: the answer changes when the gap"
            " closes"
        ),
    )
    may_let_go = True
    usual = f"gap {GAP} m, stiffness {STOP} times the mean EA/L of the members: a judgement"
    structural = True
    support: Supports
    dof: Direction
    gap: Annotated[Value, Parameter("m", None, least=0.0)]
    stiffness: Annotated[Value, Parameter("N/m", 0.0, least=0.0)] = 0.0

    def check(self, model: Model) -> None:
        only_free(model, self.support, self.dof)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=False, axes=("ux",))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"gap": GAP, "stiffness": STOP.times(mean_axial_stiffness(model))}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["stiffness"] > 0:
                spring = len(structure.arrays["spring_dof"])
                structure.add_spring(node, -1, DOFS.index(self.dof), value["stiffness"])
                structure.laws.append(Law("play", None, spring, abs(value["gap"])))
