"""Bearings that hold more, or less, than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.effect import Effect
from rga.model.parameter import Parameter, Place, Positive, Prior, Value, listed
from rga.model.schema import DOFS, Dof, Model
from rga.model.structure import HELD_BY_PLANE, Bearing, Structure

Supports = Annotated[str | list[str], Place("support")]
Direction = Annotated[Dof, Place("")]


class SupportSpring(Effect):
    """A spring [N/m] on a direction that the support leaves free: a frozen bearing."""

    kind: Literal["support_spring"] = "support_spring"
    structural = True
    support: Supports
    dof: Direction
    stiffness: Annotated[Value, Parameter("N/m", 0.0, least=0.0)] = 0.0

    def check(self, model: Model) -> None:
        only_free(model, self.support, self.dof)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=False)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"stiffness": Positive(0.1 * member_scale(model), 2.0)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["stiffness"] > 0:
                structure.add_spring(node, -1, DOFS.index(self.dof), value["stiffness"])


class SupportFlexibility(Effect):
    """A stiffness [N/m] in place of a rigid direction of a support."""

    kind: Literal["support_flexibility"] = "support_flexibility"
    structural = True
    support: Supports
    dof: Direction
    stiffness: Annotated[Value, Parameter("N/m", float("inf"), least=0.0)] = float("inf")

    def check(self, model: Model) -> None:
        for name in listed(self.support):
            if self.dof not in model.supports[name].fixed:
                raise ValueError(f"support {name!r} leaves {self.dof} free: name a held direction")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=True)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"stiffness": Positive(0.3 * member_scale(model), 1.5)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        if np.isinf(value["stiffness"]):
            return
        dof = DOFS.index(self.dof)
        for node in supported(structure, self.support):
            structure.arrays["fixed"][node, dof] = False
            structure.add_spring(node, -1, dof, value["stiffness"])


class BearingFriction(Effect):
    """Coulomb friction on a free direction: mu times (reaction + permanent_force [N]).

    Attributes:
        mu: coefficient of friction [-].
        permanent_force: part of the vertical reaction that the model's loads leave out [N].
    """

    kind: Literal["bearing_friction"] = "bearing_friction"
    structural = True
    remembers = True
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
        # What the loads of the model leave out is mostly the weight of the bridge itself.
        return {"mu": Positive(0.1, 0.7), "permanent_force": Positive(5e4, 1.0, trials=(0.0,))}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["mu"] > 0:
                structure.bearings.append(
                    Bearing(node, DOFS.index(self.dof), value["mu"], value["permanent_force"])
                )


def directions(
    model: Model, *, held: bool, axes: tuple[str, ...] = ("ux", "uy", "uz")
) -> Iterator[dict[str, Any]]:
    """Support directions that are held, or free: one by one, by lines across the bridge, all."""
    in_plane = [DOFS[k] for k in range(3) if k not in HELD_BY_PLANE.get(model.plane or "", ())]
    for dof in (axis for axis in in_plane if axis in axes):
        names = [
            name
            for name, support in model.supports.items()
            if (dof in support.fixed) == held and support.along is None
        ]
        yield from ({"support": name, "dof": dof} for name in names)
        lines: dict[float, list[str]] = {}
        for name in names:
            lines.setdefault(round(model.nodes[model.supports[name].node][0], 3), []).append(name)
        together = [*lines.values(), names] if len(lines) > 1 else [names]
        yield from ({"support": line, "dof": dof} for line in together if len(line) > 1)


def only_free(model: Model, support: str | list[str], dof: str) -> None:
    """ValueError where one of the supports holds the direction."""
    for name in listed(support):
        if dof in model.supports[name].fixed:
            raise ValueError(f"support {name!r} holds {dof}: name a free direction")


def supported(structure: Structure, support: str | list[str]) -> list[int]:
    """Nodes of the supports of a place."""
    return [structure.supports[name] for name in listed(support)]


def member_scale(model: Model) -> float:
    """Mean EA/L of the members [N/m]: the scale that a support's stiffness is measured against."""
    found = []
    for member in model.members.values():
        ends = [np.array(model.nodes[node]) for node in member.nodes]
        length = np.linalg.norm(ends[1] - ends[0])
        found.append(model.materials[member.material].E * model.sections[member.section].A / length)
    return float(np.mean(found))
