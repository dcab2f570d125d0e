"""Bearings that stick."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.supports.directions import (
    Direction,
    Supports,
    directions,
    only_free,
    supported,
)
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import DOFS, Model
from rga.model.structure import Bearing, Structure

MU = Positive(0.1, 0.7)
#: what the loads of the model leave out is mostly the weight of the bridge itself [N]
REACTION = Positive(5e4, 1.0, trials=(0.0,))


class BearingFriction(Effect):
    """Coulomb friction on a free direction: mu times (reaction + permanent_force [N]).

    `mu` and the structure beside it must not change from row to row (an onset is possible):
    friction remembers, and starts anew with another structure.

    Attributes:
        mu: coefficient of friction [-].
        permanent_force: part of the vertical reaction that the model's loads leave out [N].
    """

    kind: Literal["bearing_friction"] = "bearing_friction"
    action = Action(
        inspect="the bearing {place}: lubrication, rust, dirt, worn sliding faces",
        check="movement marks of the bearing over a day of changing temperature",
        test=(
            "record movement and temperature of the bearing over some days: it sticks, then "
            "slips, in a loop"
        ),
    )
    may_let_go = True
    usual = (
        f"mu {MU}, from greased PTFE under 30 MPa, 0.03 (EN 1337-2, table 11), to rusty steel on "
        f"steel; permanent force {REACTION} N: judgements"
    )
    structural = True
    remembers = True
    # Bearings act on each other: the simulation keeps the past of all that a structure has.
    keeps_past = True
    support: Supports
    dof: Direction
    mu: Annotated[Value, Parameter("-", 0.0, least=0.0)] = 0.0
    permanent_force: Annotated[Value, Parameter("N", None)] = 0.0

    def check(self, model: Model) -> None:
        only_free(model, self.support, self.dof)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=False, axes=("ux",))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"mu": MU, "permanent_force": REACTION}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["mu"] > 0:
                structure.bearings.append(
                    Bearing(node, DOFS.index(self.dof), value["mu"], value["permanent_force"])
                )
