"""Joints whose bolts slip."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.places import Groups, Members, only_trusses, trusses
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Law, Structure

USUAL = Positive(5e-4, 1.0, trials=(-2.0, 0.5))


class JointSlip(Effect):
    """Bolts that slip: truss members carry nothing within +-slip [m] of their length.

    A member that nothing pushes stays in the middle of its play.
    """

    kind: Literal["joint_slip"] = "joint_slip"
    action = Action(
        inspect=(
            "bolts and rivets at the ends of {place}: loose heads, rust that bleeds, worn paint"
        ),
        check="the tightening of its bolts",
        test=(
            "a known load moved slowly forth and back, with a gauge on {place}: the readings make a"
            " loop"
        ),
    )
    usual = (
        f"slip {USUAL} m: a judgement; holes are 1 to 3 mm wider than their bolts (EN 1090-2, "
        "table 11)"
    )
    structural = True
    member: Members = None
    group: Groups = None
    slip: Annotated[Value, Parameter("m", 0.0, least=0.0)] = 0.0

    def check(self, model: Model) -> None:
        only_trusses(self, model, self.member, self.group)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from trusses(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"slip": USUAL}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for member in structure.named(self.member, self.group):
            structure.laws.append(Law("play", int(member), None, abs(value["slip"])))
