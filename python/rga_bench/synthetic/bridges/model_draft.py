"""A model file in the making: the parts that all bridge generators share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

ModelDict = dict[str, Any]


@dataclass(frozen=True)
class Bridge:
    """A model and what a hidden effect must know about it.

    ``roles`` names the context of each role: temperature, area (distributed load), position
    and weight (cart), idle (measured, but driving nothing in the model). ``peaks`` gives the
    size of each role in its unit. ``bearings`` are the (support, dof) that may expand,
    ``floor`` the chord groups a deck could share, ``jointed`` the groups that are stiff-jointed
    in a frame reality, ``carts`` the cart's effects.
    """

    name: str
    model: ModelDict
    roles: dict[str, str]
    peaks: dict[str, float]
    bearings: list[tuple[str, str]]
    floor: list[str]
    jointed: list[str]
    area_load: str
    carts: list[str] = field(default_factory=list)
    push: tuple[float, float, float] = (0.0, 1.0, 0.0)  # direction of the idle context's load


class Draft:
    """Collects nodes, members and sensors under the names a bridge gives them."""

    def __init__(self, name: str, materials: ModelDict, sections: ModelDict) -> None:
        self.model: ModelDict = {
            "rga_model": 1,
            "name": name,
            "materials": materials,
            "sections": sections,
            "nodes": {},
            "members": {},
            "supports": {},
            "context": {},
            "effects": {},
            "sensors": {},
        }

    def node(self, name: str, x: float, y: float, z: float) -> None:
        self.model["nodes"][name] = [round(x, 6), round(y, 6), round(z, 6)]

    def member(
        self,
        ends: tuple[str, str],
        section: str,
        groups: list[str],
        *,
        name: str = "",
        material: str = "steel",
        kind: str = "truss",
    ) -> None:
        self.model["members"][name or "-".join(ends)] = {
            "nodes": list(ends),
            "section": section,
            "material": material,
            "kind": kind,
            "groups": groups,
        }

    def support(self, name: str, node: str, *fixed: str) -> None:
        self.model["supports"][name] = {"node": node, "fixed": list(fixed)}

    def context(self, name: str, unit: str, low: float, high: float) -> None:
        self.model["context"][name] = {"unit": unit, "range": [low, high]}

    def warmth(self, name: str, context: str, zero: float, groups: dict[str, float]) -> None:
        self.model["effects"][name] = {
            "kind": "temperature",
            "groups": groups,
            "delta": {"context": context, "minus": zero},
        }

    def area(self, name: str, context: str, down: dict[str, float]) -> None:
        """Distributed load: ``down`` [N per unit of the context] at each node."""
        self.model["effects"][name] = {
            "kind": "nodal_load",
            "forces": {node: [0, 0, -round(force, 3)] for node, force in down.items()},
            "factor": {"context": context},
        }

    def cart(self, name: str, path: list[str], share: float, position: str, weight: str) -> None:
        self.model["effects"][name] = {
            "kind": "axle_load",
            "path": path,
            "carried_by": "nodes",
            "forces": [share],
            "offsets": [0.0],
            "factor": {"context": weight},
            "position": {"context": position},
        }

    def moves(self, name: str, node: str, direction: list[int], noise: float) -> None:
        """Displacement sensor [mm]."""
        self.model["sensors"][name] = {
            "kind": "displacement",
            "node": node,
            "direction": direction,
            "unit": "mm",
            "noise": noise,
        }

    def tilts(self, name: str, node: str, direction: list[int], noise: float) -> None:
        """Rotation sensor [mrad]."""
        self.model["sensors"][name] = {
            "kind": "rotation",
            "node": node,
            "direction": direction,
            "unit": "mrad",
            "noise": noise,
        }

    def strains(self, name: str, member: str, noise: float) -> None:
        """Strain gauge [microstrain]."""
        self.model["sensors"][name] = {
            "kind": "strain",
            "member": member,
            "unit": "microstrain",
            "noise": noise,
        }


def steel(modulus: float = 2.0e11) -> dict[str, float]:
    """Structural steel: E [Pa], alpha [1/K], density [kg/m3]."""
    return {"E": modulus, "nu": 0.3, "alpha": 1.2e-5, "density": 7850}


def section(area: float, inertia: float, torsion: float) -> dict[str, float]:
    """A section alike about both axes: A [m2], I [m4], J [m4]."""
    return {"A": area, "Iy": inertia, "Iz": inertia, "J": torsion}
