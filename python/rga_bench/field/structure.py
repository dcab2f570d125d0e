"""A structure of the field: a model file, and what nature and site do to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from rga_bench.synthetic.bridges.model_draft import Draft, ModelDict

#: how a context moves over time
Mood = Literal["air", "wind", "snow", "traffic", "trolley", "hoist"]


@dataclass(frozen=True)
class FieldStructure:
    """A structure as its engineer modelled it.

    ``moods``: of every context, how it moves and its size in its unit; ``depths``: of every
    section, half of its depth [m], where a gauge can stand off the centroid; ``loads``: effects
    that may be off by a factor.
    """

    name: str
    model: ModelDict
    moods: dict[str, tuple[Mood, float]]
    depths: dict[str, float]
    loads: list[str]

    @property
    def air(self) -> str:
        """The context that is the temperature."""
        return next(name for name, (mood, _) in self.moods.items() if mood == "air")


def tube(diameter: float, wall: float) -> dict[str, float]:
    """A round tube [m]: A, I and J by the thin-walled formulas of EN 10210-2, annex A."""
    inner = diameter - 2.0 * wall
    area = 0.25 * 3.141592653589793 * (diameter**2 - inner**2)
    inertia = 3.141592653589793 / 64.0 * (diameter**4 - inner**4)
    return {"A": area, "Iy": inertia, "Iz": inertia, "J": 2.0 * inertia}


def pushes(draft: Draft, name: str, context: str, forces: dict[str, list[float]]) -> None:
    """Forces [N per unit of the context] at nodes."""
    draft.model["effects"][name] = {
        "kind": "nodal_load",
        "forces": {node: [round(x, 3) for x in force] for node, force in forces.items()},
        "factor": {"context": context},
    }


def fibre(draft: Draft, name: str, member: str, noise: float, at: float, z: float) -> None:
    """A gauge at a fibre of a frame member [microstrain]."""
    draft.strains(name, member, noise)
    draft.model["sensors"][name] |= {"at": at, "z": round(z, 4)}


def frame(
    draft: Draft, ends: tuple[str, str], section: str, groups: list[str], **more: Any
) -> None:
    """A member that bends in the plane xz about its strong axis y."""
    draft.member(ends, section, groups, kind="frame", **more)
    draft.model["members"][more.get("name") or "-".join(ends)]["local_y"] = [0.0, 1.0, 0.0]
