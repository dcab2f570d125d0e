"""Rods and cables that go slack."""

from collections.abc import Mapping
from typing import Annotated, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.places import Groups, Members, only_trusses
from rga.model.parameter import Parameter, Value
from rga.model.schema import Model
from rga.model.structure import Law, Structure


class TensionOnly(Effect):
    """Rods and cables: truss members carry nothing until they are longer by a slack [m].

    This is a matter of design, and how far dead load keeps a member taut is not in a model of what
    changes, so a diagnosis does not propose it. It takes no onset.
    """

    kind: Literal["tension_only"] = "tension_only"
    action = Action(
        inspect="{place}: slack rods or cables, turnbuckles, pins",
        check="its tension (by its frequency)",
        test="{load}, with a gauge on {place}: it stays idle until the slack is taken up",
    )
    structural = True
    member: Members = None
    group: Groups = None
    slack: Annotated[Value, Parameter("m", None)]

    def check(self, model: Model) -> None:
        only_trusses(self, model, self.member, self.group)
        if self.onset is not None:
            raise ValueError("tension_only has no onset: a member is a rod or it is none")

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for member in structure.named(self.member, self.group):
            structure.laws.append(Law("tension", int(member), None, value["slack"]))
