"""Gussets that stiffen the ends of members."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.parameter import Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Positive(0.3, 0.7)


class RigidEndZone(Effect):
    """A rigid length at each end of frame members: gussets. They expand as their members do."""

    kind: Literal["rigid_end_zone"] = "rigid_end_zone"
    action = Action(
        inspect="size and thickness of the gusset plates of {place}",
        check="the lengths between gussets in the drawings",
        test="{load}, with gauges in the middle of a member of {place} and beside its gusset",
    )
    usual = f"length {USUAL} m: a judgement"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    length: Annotated[Value, Parameter("m", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        framed = [
            group
            for group, names in model.groups.items()
            if any(model.members[name].kind == "frame" for name in names)
        ]
        yield from ({"group": group} for group in framed)
        if len(framed) > 1:
            yield {"group": framed}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"length": USUAL}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        chosen = structure.named(None, self.group)
        longest = 0.45 * structure.lengths[chosen]
        structure.arrays["rigid_end"][chosen] = np.minimum(value["length"], longest)[:, None]
