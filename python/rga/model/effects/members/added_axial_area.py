"""Decks that share the force of members."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.scales import mean_area
from rga.model.parameter import Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Positive(0.3, 1.0)


class AddedAxialArea(Effect):
    """Area [m2] parallel to the members of a group, fully tied: a deck that shares the force."""

    kind: Literal["added_axial_area"] = "added_axial_area"
    action = Action(
        inspect=(
            "what lies along {place} and could share its force: deck, stringers, rails, pipes, "
            "and what ties them to it"
        ),
        check="whether the drawings show a deck or floor tied to {place}",
        test="{load}, with gauges on {place} and on what may share its force",
    )
    usual = f"area {USUAL} times the mean area of the group: a judgement"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    area: Annotated[Value, Parameter("m2", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"area": USUAL.times(mean_area(model, place["group"]))}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        chosen = structure.named(None, self.group)
        if value["area"] > 0:
            structure.add_bars(structure.arrays["ends"][chosen], value["area"], chosen)
