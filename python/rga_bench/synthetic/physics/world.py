"""A bridge as it really is: the model's structure with what reality adds to it."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rga_bench.synthetic.bridges.model_draft import ModelDict
from rga_bench.synthetic.physics.frame import DOFS, Array, FrameSpring, Geometry, Stiffness


@dataclass
class StrandBar:
    """One bar of a chord that runs beside the truss; only its ends' x matters.

    ``a`` and ``b`` are degrees of freedom, ``member`` the truss member whose temperature
    it shares.
    """

    a: int
    b: int
    member: int
    stiffness: float  # [N/m]


@dataclass
class Friction:
    """Coulomb friction at bearings: ``dofs`` that slide, ``normal`` dofs that carry [N]."""

    dofs: list[int]
    normals: list[int]
    mu: float
    permanent: float


@dataclass
class Stop:
    """Stops at bearings: a stiffness [N/m] beyond a gap [m] to either side."""

    dofs: list[int]
    gap: float
    stiffness: float


@dataclass
class Curiosity:
    """What no vocabulary holds: see ``response.py`` for the meaning of each variant."""

    variant: str
    amount: float
    force: Array  # [d] pattern of the strange response


@dataclass
class World:
    """Mutable description of reality; effects change copies of it.

    Arrays over members are of shape [m], in the order of the model.
    """

    model: ModelDict
    geometry: Geometry
    section: Stiffness
    alpha: Array
    held: set[int]
    springs: list[FrameSpring] = field(default_factory=list)
    strands: list[StrandBar] = field(default_factory=list)
    extra: int = 0
    gradient: dict[str, tuple[float, float]] = field(default_factory=dict)  # axis: ratio, diff.
    settlement: dict[int, float] = field(default_factory=dict)
    load_factor: dict[str, float] = field(default_factory=dict)
    load_shift: dict[str, float] = field(default_factory=dict)
    load_share: dict[str, float] = field(default_factory=dict)
    added_load: list[tuple[str, Array]] = field(default_factory=list)  # context, force [d]
    friction: Friction | None = None
    slip: Array | None = None  # [m] of every member to either side
    stop: Stop | None = None
    curiosity: Curiosity | None = None
    sensor_ops: list[tuple[str, Any]] = field(default_factory=list)
    context_ops: list[tuple[str, str, float]] = field(default_factory=list)

    @classmethod
    def of(cls, model: ModelDict) -> World:
        """The structure exactly as the model has it."""
        nodes = list(model["nodes"])
        place = {name: i for i, name in enumerate(nodes)}
        members = list(model["members"].values())
        ends = np.array([[place[n] for n in m["nodes"]] for m in members], dtype=np.int64)
        xyz = np.array([model["nodes"][n] for n in nodes], dtype=float)

        def section(key: str) -> Array:
            return np.array([float(model["sections"][m["section"]][key]) for m in members])

        def material(key: str) -> Array:
            return np.array([float(model["materials"][m["material"]][key]) for m in members])

        e = material("E")
        shear = e / (2.0 * (1.0 + material("nu")))
        rigid = np.array([np.inf if m["kind"] == "frame" else 0.0 for m in members])
        held = {
            6 * place[s["node"]] + DOFS.index(dof)
            for s in model["supports"].values()
            for dof in s["fixed"]
        }
        if model.get("plane") == "xz":
            held |= {6 * i + d for i in range(len(nodes)) for d in (1, 3, 5)}
        return cls(
            model=model,
            geometry=Geometry.of(xyz, ends),
            section=Stiffness(
                e * section("A"), e * section("Iy"), e * section("Iz"), shear * section("J"), rigid
            ),
            alpha=material("alpha"),
            held=held,
        )

    def copy(self) -> World:
        """An independent copy; the model and the geometry, which nothing changes, are shared."""
        shared = {id(self.model): self.model, id(self.geometry): self.geometry}
        return copy.deepcopy(self, shared)

    @property
    def size(self) -> int:
        """Number of degrees of freedom, extras included."""
        return 6 * len(self.geometry.xyz) + self.extra

    def dof(self, node: str, name: str) -> int:
        return 6 * list(self.model["nodes"]).index(node) + DOFS.index(name)

    def support_dof(self, support: str, name: str) -> int:
        return self.dof(self.model["supports"][support]["node"], name)

    def members_of(self, *, group: str = "", member: str = "", material: str = "") -> Array:
        """Mask over members [m]: those in a group, of a name or of a material."""
        return np.array(
            [
                group in m["groups"] or name == member or m["material"] == material
                for name, m in self.model["members"].items()
            ]
        )

    def scale_stiffness(self, factor: Array) -> None:
        """Multiply EA, EI and GJ of every member by ``factor`` [m]."""
        s = self.section
        self.section = Stiffness(
            s.ea * factor, s.ei_y * factor, s.ei_z * factor, s.gj * factor, s.end_spring
        )

    def join(self, groups: list[str], stiffness: float) -> None:
        """Make the truss members of ``groups`` frame members with end springs [N m/rad]."""
        spring = self.section.end_spring.copy()
        for group in groups:
            mask = self.members_of(group=group) & (spring == 0.0)
            spring[mask] = stiffness
        self.section = self.section._replace(end_spring=spring)
