"""Reality: the structure as it stands, and what its loads and warmth do to it."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from rga_bench.field.solver import DOFS, Array, Bars, Solved, axes_of
from rga_bench.field.structure import FieldStructure

Contexts = dict[str, Array]
_PER_SI = {"mm": 1e3, "mrad": 1e3, "microstrain": 1e6}
#: of the shear modulus, by EN 1993-1-1, 3.2.6
_POISSON = 0.3
#: degrees of freedom that a model in the plane xz holds at every node
_OUT_OF_PLANE = (1, 3, 5)


class Gauge(NamedTuple):
    """Where a gauge really stands: share of the length, fibre [m]."""

    at: float
    y: float
    z: float


@dataclass
class FieldWorld:
    """Reality; effects change copies of it.

    ``gradient``: by axis, the parameter's name and value; ``settled`` [m or rad] by degree of
    freedom; ``ops``: what happens to readings; ``strange``: what no vocabulary has, and how much.
    """

    structure: FieldStructure
    xyz: Array
    bars: Bars
    held: set[int]
    gauges: dict[str, Gauge]
    springs: dict[int, float] = field(default_factory=dict)
    settled: dict[int, float] = field(default_factory=dict)
    load_factor: dict[str, float] = field(default_factory=dict)
    gradient: dict[str, tuple[str, float]] = field(default_factory=dict)
    ops: list[tuple[str, Any]] = field(default_factory=list)
    strange: tuple[str, Any, float] | None = None

    @classmethod
    def of(cls, structure: FieldStructure) -> FieldWorld:
        """The structure exactly as its model has it."""
        model = structure.model
        place = {name: k for k, name in enumerate(model["nodes"])}
        xyz = np.array(list(model["nodes"].values()), dtype=float)
        members = list(model["members"].values())
        ends = np.array([[place[n] for n in m["nodes"]] for m in members], dtype=np.int64)
        axes = [
            axes_of(xyz[j] - xyz[i], np.array(m["local_y"]) if "local_y" in m else None)
            for (i, j), m in zip(ends, members, strict=True)
        ]

        def section(key: str) -> Array:
            return np.array([model["sections"][m["section"]].get(key, 0.0) for m in members])

        def material(key: str) -> Array:
            return np.array([float(model["materials"][m["material"]][key]) for m in members])

        e = material("E")
        bars = Bars(
            ends=ends,
            axes=np.array(axes),
            ea=e * section("A"),
            ei_y=e * section("Iy"),
            ei_z=e * section("Iz"),
            gj=e / (2.0 * (1.0 + _POISSON)) * section("J"),
            alpha=material("alpha"),
            pinned=np.array([m["kind"] == "truss" for m in members]),
            zone=np.zeros(len(members)),
        )
        held = {
            6 * place[s["node"]] + DOFS.index(dof)
            for s in model["supports"].values()
            for dof in s["fixed"]
        }
        if model.get("plane") == "xz":
            held |= {6 * k + dof for k in range(len(xyz)) for dof in _OUT_OF_PLANE}
        gauges = {
            name: Gauge(one.get("at", 0.5), one.get("y", 0.0), one.get("z", 0.0))
            for name, one in model["sensors"].items()
            if one["kind"] == "strain"
        }
        return cls(structure, xyz, bars, held, gauges)

    def copy(self) -> FieldWorld:
        """An independent copy; the structure, which nothing changes, is shared."""
        return copy.deepcopy(self, {id(self.structure): self.structure})

    def member(self, name: str) -> int:
        return list(self.structure.model["members"]).index(name)

    def dof(self, node: str, name: str) -> int:
        return 6 * list(self.structure.model["nodes"]).index(node) + DOFS.index(name)

    def support_dof(self, support: str, name: str) -> int:
        return self.dof(self.structure.model["supports"][support]["node"], name)


def warmth(world: FieldWorld, contexts: Contexts) -> Array:
    """Kelvin above the temperature of erection, [n]."""
    delta = world.structure.model["effects"]["warmth"]["delta"]
    return contexts[delta["context"]] - float(delta["minus"])


def influence(world: FieldWorld) -> Array:
    """Channels [p, c] under a unit of every pattern: warmth, gradients, settlement, loads."""
    model = world.structure.model
    size, many = 6 * len(world.xyz), len(world.bars.ends)
    forces, warm, moved = [], [], []

    def pattern(force: Array | None = None, kelvin: Array | None = None) -> None:
        forces.append(np.zeros(size) if force is None else force)
        warm.append(np.zeros(many) if kelvin is None else kelvin)
        moved.append(np.zeros(size))

    groups = model["effects"]["warmth"]["groups"]
    own = [sum(groups.get(g, 0.0) for g in m["groups"]) for m in model["members"].values()]
    pattern(kelvin=np.array(own))
    for axis, column in (("vertical", 2), ("lateral", 1)):
        pattern(kelvin=_gradient(world, column) if axis in world.gradient else None)
    pattern()
    for dof, value in world.settled.items():
        moved[-1][dof] = value
    for effect in model["effects"].values():
        if effect["kind"] == "nodal_load":
            force = np.zeros(size)
            for node, parts in effect["forces"].items():
                force[world.dof(node, "ux") : world.dof(node, "ux") + 3] = parts
            pattern(force=force)
        elif effect["kind"] == "axle_load":
            for node in effect["path"]:
                force = np.zeros(size)
                force[world.dof(node, "uz")] = -float(effect["forces"][0])
                pattern(force=force)
    solved = Solved(
        world.xyz, world.bars, world.held, world.springs,
        np.array(forces).T, np.array(warm).T, np.array(moved).T,
    )  # fmt: skip
    return np.column_stack([_channel(world, name, solved) for name in model["sensors"]])


def _channel(world: FieldWorld, name: str, solved: Solved) -> Array:
    sensor = world.structure.model["sensors"][name]
    scale = _PER_SI[sensor["unit"]]
    if sensor["kind"] == "strain":
        gauge = world.gauges[name]
        return scale * solved.strain(world.member(sensor["member"]), gauge.at, gauge.y, gauge.z)
    first = world.dof(sensor["node"], "ux" if sensor["kind"] == "displacement" else "rx")
    return np.asarray(scale * (np.array(sensor["direction"]) @ solved.u[first : first + 3]))


def amplitudes(world: FieldWorld, contexts: Contexts) -> Array:
    """How much of every pattern there is in every row, [n, p]."""
    kelvin = warmth(world, contexts)
    columns = [kelvin]
    for axis in ("vertical", "lateral"):
        word, value = world.gradient.get(axis, ("difference", 0.0))
        columns.append(value * (kelvin if word == "ratio" else np.ones_like(kelvin)))
    columns.append(np.ones_like(kelvin))
    for name, effect in world.structure.model["effects"].items():
        if effect["kind"] not in ("nodal_load", "axle_load"):
            continue
        amount = world.load_factor.get(name, 1.0) * contexts[effect["factor"]["context"]]
        if effect["kind"] == "nodal_load":
            columns.append(amount)
            continue
        shares = _levers(world, effect["path"], contexts[effect["position"]["context"]])
        columns += [amount * share for share in shares]
    return np.column_stack(columns)


def _levers(world: FieldWorld, path: list[str], position: Array) -> list[Array]:
    """Share of an axle that each node of its path carries, [n] each."""
    points = np.array([world.structure.model["nodes"][node] for node in path])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    on = (position >= 0.0) & (position <= arc[-1])
    unit = np.eye(len(arc))
    return [np.where(on, np.interp(position, arc, unit[k]), 0.0) for k in range(len(arc))]


def _gradient(world: FieldWorld, column: int) -> Array:
    """Kelvin of every member per kelvin of difference, from its middle, [m]."""
    across = np.array(list(world.structure.model["nodes"].values()))[:, column]
    low, high = across.min(), across.max()
    middle = across[world.bars.ends].mean(axis=1)
    return np.asarray((middle - 0.5 * (low + high)) / (high - low))
