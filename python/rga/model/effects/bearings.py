"""Bearings that hold more, or less, than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.bending import bending_at
from rga.model.effect import Effect
from rga.model.parameter import Parameter, Place, Positive, Prior, Value, listed
from rga.model.schema import DOFS, Dof, Model
from rga.model.structure import HELD_BY_PLANE, Bearing, Structure

Supports = Annotated[str | list[str], Place("support")]
Direction = Annotated[Dof, Place("")]
#: A base between a pin and a clamp, over the sum of EI/L of the members that bend with it, as the
#: middle and the spread of a log-normal whose 90 % range is that of semi-rigid joints: below 30 a
#: column base is not rigid in a frame that sways, below 0.5 a joint is as good as a pin
#: (EN 1993-1-8, 5.2.2.5). A base that was meant as a pin lies in it too: a tenth of the stiffness
#: of the column, 0.4, is what BS 5950-1, 5.1.3 lets one count on there.
PINNED, RIGID = 0.5, 30.0
BASE = float(np.sqrt(PINNED * RIGID))
BASE_SPREAD = float(np.log(RIGID / PINNED) / (2 * 1.645))


class SupportSpring(Effect):
    """A spring [N/m or N m/rad] on a direction that the support leaves free.

    A frozen bearing, or a base that was taken as a pin and holds a moment.
    """

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
        yield from rotations(model, held=False)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        along = Positive(0.1 * member_scale(model), 2.0)
        return {"stiffness": _base(model, place) if turns(place["dof"]) else along}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["stiffness"] > 0:
                structure.add_spring(node, -1, DOFS.index(self.dof), value["stiffness"])


class SupportFlexibility(Effect):
    """A stiffness [N/m or N m/rad] in place of a rigid direction of a support."""

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
        yield from rotations(model, held=True)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        along = Positive(0.3 * member_scale(model), 1.5)
        return {"stiffness": _base(model, place) if turns(place["dof"]) else along}

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
    for dof in (axis for axis in _in_plane(model, DOFS[:3]) if axis in axes):
        yield from _alone_and_together(model, dof, _acting(model, dof, held))


def rotations(model: Model, *, held: bool) -> Iterator[dict[str, Any]]:
    """The same of rotations that bend a frame member there: that of a pin means nothing."""
    for dof in _in_plane(model, DOFS[3:]):
        bent = [
            name
            for name in _acting(model, dof, held)
            if bending_at(model, model.supports[name].node, dof) > 0
        ]
        yield from _alone_and_together(model, dof, bent)


def turns(dof: str) -> bool:
    """Whether a dof is a rotation."""
    return DOFS.index(dof) >= 3


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


def _in_plane(model: Model, dofs: tuple[str, ...]) -> list[str]:
    held = [DOFS[k] for k in HELD_BY_PLANE.get(model.plane or "", ())]
    return [dof for dof in dofs if dof not in held]


def _acting(model: Model, dof: str, held: bool) -> list[str]:
    """Supports that hold a dof, or leave it free."""
    return [
        name
        for name, support in model.supports.items()
        if (dof in support.fixed) == held and support.along is None
    ]


def _alone_and_together(model: Model, dof: str, names: list[str]) -> Iterator[dict[str, Any]]:
    """A dof of supports one by one, by lines across the bridge, and of all."""
    yield from ({"support": name, "dof": dof} for name in names)
    lines: dict[float, list[str]] = {}
    for name in names:
        lines.setdefault(round(model.nodes[model.supports[name].node][0], 3), []).append(name)
    together = [*lines.values(), names] if len(lines) > 1 else [names]
    yield from ({"support": line, "dof": dof} for line in together if len(line) > 1)


def _base(model: Model, place: Mapping[str, Any]) -> Positive:
    """What is known of the rotational stiffness of a support [N m/rad]."""
    nodes = [model.supports[name].node for name in listed(place["support"])]
    mean = float(np.mean([bending_at(model, node, place["dof"]) for node in nodes]))
    return Positive(BASE * mean, BASE_SPREAD)
