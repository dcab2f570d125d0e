"""A structure as arrays: what effects change and what the core solves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from rga.arrays import (
    FloatArray,
    IntArray,
    MassArrays,
    OutputArrays,
    StructureArrays,
    by_name,
)
from rga.model.copied_when_read import CopiedWhenRead
from rga.model.parameter import SMALLEST, listed
from rga.model.schema import Model, Vector
from rga.model.structure.arrays import member_arrays, restraint_arrays, sensor_output
from rga.model.structure.masses import masses_of
from rga.model.units import per_si

T = TypeVar("T")
#: what was built, under the numbers (id) of what it was built of; these are kept with it, so that
#: nothing else gets such a number
Built = dict[tuple[int | bytes, ...], tuple[tuple[object, ...], Any]]
#: a load along a member: its number, local axis, from, to [m], start, end
Spread = tuple[int, int, float, float, float, float]
#: what a structure remembers of effects
REMEMBERED = 512
#: where nodes are, which of them members join, how these stand, and which supports are inclined
GEOMETRY: tuple[Literal["coordinates", "ends", "frame", "local_y", "inclined_node"], ...] = (
    "coordinates",
    "ends",
    "frame",
    "local_y",
    "inclined_node",
)
#: properties that a member has and a node has not
OF_MEMBERS: tuple[
    Literal["E", "G", "A", "Iy", "Iz", "J", "Asy", "Asz", "local_y", "connection", "rigid_end"], ...
] = ("E", "G", "A", "Iy", "Iz", "J", "Asy", "Asz", "local_y", "connection", "rigid_end")


@dataclass
class Load:
    """A load pattern with a coefficient for every row.

    Attributes:
        coefficient: float[rows].
        forces: node -> six force and moment components [N, N m].
        strain: initial axial strain of every member, float[members], or None.
        prescribed: (node, dof) -> displacement of a support [m or rad].
        spread: (member, axis, from, to, start, end) of loads along members.
        permanent: a load that no context drives.
    """

    coefficient: FloatArray
    forces: dict[int, FloatArray] = field(default_factory=dict)
    strain: FloatArray | None = None
    prescribed: dict[tuple[int, int], float] = field(default_factory=dict)
    spread: list[Spread] = field(default_factory=list)
    permanent: bool = False

    def times(self, coefficient: FloatArray) -> "Load":
        """The same pattern with other coefficients."""
        return Load(
            coefficient, self.forces, self.strain, self.prescribed, self.spread, self.permanent
        )

    @property
    def pattern(self) -> tuple[object, ...]:
        """What the load does where its coefficient is one, as objects; None for nothing."""
        return self.forces or None, self.strain, self.prescribed or None, self.spread or None


@dataclass(frozen=True)
class Bearing:
    """A support direction with Coulomb friction."""

    node: int
    dof: int
    mu: float
    permanent_force: float


@dataclass(frozen=True)
class Law:
    """A member or spring that carries nothing until its elongation leaves a range.

    Attributes:
        kind: `play` is idle within +-size, `tension` up to size.
        member, spring: its number, one of the two.
        size: [m].
    """

    kind: Literal["play", "tension"]
    member: int | None
    spring: int | None
    size: float


@dataclass
class Structure:
    """The structure of a model as arrays in the form that the core takes.

    Attributes:
        nodes, members, supports, sensors: names -> numbers.
        groups: group -> numbers of its members.
        materials: material of every member of the model.
        drawn_frames: numbers of the members that are frames in the model, whatever effects make.
        arrays: coordinates [m], member properties, supports, springs, ties.
        masses: along members and at nodes, as the core takes them.
        weigh: masses of some materials, and of some masses by name, of the model.
        outputs: one row a sensor, as the core takes them.
        per_si: sensor units per SI unit, float[sensors].
        alpha: thermal expansion [1/K], float[members].
        host: number of the member whose temperature a member shares, int[members].
        bearings: bearings with friction.
        laws: members and springs that carry nothing within some play.
        nonlinear: equilibrium is that of the deformed structure.
    """

    nodes: dict[str, int]
    members: dict[str, int]
    supports: dict[str, int]
    sensors: dict[str, int]
    groups: dict[str, IntArray]
    materials: tuple[str, ...]
    drawn_frames: IntArray
    arrays: StructureArrays
    masses: MassArrays
    weigh: Callable[[Sequence[str], Sequence[str]], MassArrays]
    outputs: OutputArrays
    per_si: FloatArray
    alpha: FloatArray
    host: IntArray
    bearings: list[Bearing]
    laws: list[Law]
    nonlinear: bool
    _built: Built = field(default_factory=dict, repr=False, compare=False)
    _built_for_geometry: Built = field(default_factory=dict, repr=False, compare=False)
    _named: Built = field(default_factory=dict, repr=False, compare=False)

    @property
    def linear(self) -> bool:
        """True where loads that add up make responses that add up."""
        return not self.bearings and self.linear_but_friction

    @property
    def linear_but_friction(self) -> bool:
        """The same without regard to friction."""
        return not (self.laws or self.nonlinear)

    def once(self, build: Callable[[], T], *of: object) -> T:
        """What `build` makes of some objects and this structure, built at the first call.

        For what no parameter changes, once the structure is as it is to be: a load pattern, say.
        """
        return _once(self._built, tuple(map(id, of)), build, of)

    def once_for_geometry(self, build: Callable[[], T], *of: object) -> T:
        """The same for what follows from the geometry alone: copies of one geometry share it."""
        # Not by arrays[name]: a copy would hold arrays of its own from then on.
        geometry = (self.arrays.get(name) for name in GEOMETRY)
        content = (array.tobytes() for array in geometry if array is not None)
        return _once(self._built_for_geometry, (*content, *map(id, of)), build, of)

    def copy(self) -> "Structure":
        """A copy for effects to change; this structure is not to be changed any more."""
        return Structure(
            self.nodes,
            self.members,
            self.supports,
            self.sensors,
            self.groups,
            self.materials,
            self.drawn_frames,
            cast(StructureArrays, CopiedWhenRead(by_name(self.arrays))),
            cast(MassArrays, CopiedWhenRead(by_name(self.masses))),
            self.weigh,
            cast(OutputArrays, CopiedWhenRead(by_name(self.outputs))),
            self.per_si,
            self.alpha.copy(),
            self.host.copy(),
            list(self.bearings),
            list(self.laws),
            self.nonlinear,
            _built_for_geometry=self._built_for_geometry,
            _named=self._named,
        )

    def same_geometry(self, other: "Structure") -> bool:
        """Whether nodes, members and inclined supports stand as those of another structure."""
        # Not by arrays[name]: a copy would hold arrays of its own from then on.
        pairs = [(self.arrays.get(name), other.arrays.get(name)) for name in GEOMETRY]
        return all(one is two or _equal(one, two) for one, two in pairs)

    @property
    def lengths(self) -> FloatArray:
        """Member lengths, float[members] [m]."""
        ends = self.arrays["coordinates"][self.arrays["ends"]]
        return np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))

    def of_material(self, material: str | list[str]) -> NDArray[np.bool_]:
        """True for members of a material, those that share a host's temperature included."""
        made_of = np.isin(self.materials, listed(material))
        return np.asarray(made_of[self.host])

    def named(self, member: str | list[str] | None, group: str | list[str] | None) -> IntArray:
        """Numbers of the members that a place names, each once."""

        def found() -> IntArray:
            numbers = {self.members[name] for name in listed(member)}
            numbers.update(*(self.groups[name].tolist() for name in listed(group)))
            return np.array(sorted(numbers), dtype=np.int64)

        return _once(self._named, (id(member), id(group)), found, (member, group))

    def add_nodes(self, coordinates: FloatArray) -> IntArray:
        """Add nodes at coordinates float[k, 3] [m]; their numbers."""
        first = len(self.arrays["coordinates"])
        self.arrays["coordinates"] = np.vstack([self.arrays["coordinates"], coordinates])
        held = np.zeros((len(coordinates), 6), dtype=bool)
        self.arrays["fixed"] = np.vstack([self.arrays["fixed"], held])
        self.masses["nodal"] = np.vstack([self.masses["nodal"], np.zeros((len(coordinates), 6))])
        return np.arange(first, first + len(coordinates))

    def add_bars(self, ends: IntArray, area: float, hosts: IntArray) -> None:
        """Add bars int[k, 2] of an area [m2] with modulus and temperature of their hosts.

        They stand for a stiffness, and have no mass.
        """
        arrays = self.arrays
        for name in OF_MEMBERS:
            arrays[name] = np.concatenate([arrays[name], arrays[name][hosts]])
        arrays["A"][-len(hosts) :] = area
        arrays["ends"] = np.vstack([arrays["ends"], ends])
        arrays["frame"] = np.concatenate([arrays["frame"], np.zeros(len(hosts), dtype=bool)])
        self.masses["line"] = np.append(self.masses["line"], np.zeros(len(hosts)))
        self.masses["section"] = np.vstack([self.masses["section"], np.zeros((len(hosts), 3))])
        self.alpha = np.concatenate([self.alpha, self.alpha[hosts]])
        self.host = np.concatenate([self.host, self.host[hosts]])

    def add_spring(self, node: int, to: int, dof: int, stiffness: float) -> None:
        """Add a spring between two nodes, or to the ground (to = -1) [N/m or N m/rad]."""
        self.add_springs(np.array([[node, to]]), dof, stiffness)

    def add_springs(self, nodes: IntArray, dof: int, stiffness: float) -> None:
        """Add a spring between each pair of nodes, int[k, 2] [N/m or N m/rad]."""
        arrays, more = self.arrays, len(nodes)
        arrays["spring_node"] = np.concatenate([arrays["spring_node"], nodes])
        arrays["spring_dof"] = np.append(arrays["spring_dof"], np.full(more, dof))
        arrays["spring_stiffness"] = np.append(arrays["spring_stiffness"], np.full(more, stiffness))


def _once(
    built: Built, key: tuple[int | bytes, ...], build: Callable[[], T], of: tuple[object, ...]
) -> T:
    known = built.get(key)
    if known is not None:
        found: T = known[1]
        return found
    made = build()
    if len(built) >= REMEMBERED:
        built.clear()
    built[key] = of, made
    return made


def _equal(one: NDArray[Any] | None, other: NDArray[Any] | None) -> bool:
    """Whether arrays are the same bit by bit: what is not a number is the same as itself."""
    if one is None or other is None or one.shape != other.shape:
        return False
    return one.tobytes() == other.tobytes()


def check_direction(direction: Vector) -> None:
    """ValueError where a direction points nowhere."""
    if max(map(abs, direction)) < SMALLEST:
        raise ValueError(f"the direction {list(direction)} points nowhere")


def unit_vector(direction: Vector) -> FloatArray:
    """A direction of length one, float[3]."""
    return np.asarray(np.array(direction) / np.linalg.norm(direction))


def build_structure(model: Model) -> Structure:
    """The arrays of a model, before any of its effects.

    Raises:
        InputError: a sensor's unit does not belong to its kind.
    """
    nodes = {name: number for number, name in enumerate(model.nodes)}
    members = {name: number for number, name in enumerate(model.members)}
    arrays: StructureArrays = {
        **member_arrays(model, nodes),
        **restraint_arrays(model, nodes),
    }
    sensors = list(model.sensors.items())
    outputs = [sensor_output(sensor, nodes, members) for _, sensor in sensors]
    return Structure(
        nodes=nodes,
        members=members,
        supports={name: nodes[support.node] for name, support in model.supports.items()},
        sensors={name: number for number, (name, _) in enumerate(sensors)},
        groups={
            group: np.array([members[name] for name in names], dtype=np.int64)
            for group, names in model.groups.items()
        },
        materials=tuple(member.material for member in model.members.values()),
        drawn_frames=np.flatnonzero(arrays["frame"]),
        arrays=arrays,
        masses=masses_of(model),
        weigh=lambda materials, names: masses_of(model, materials, names),
        outputs={
            "kind": np.array([row[0] for row in outputs], dtype=np.int64),
            "index": np.array([row[1] for row in outputs], dtype=np.int64),
            "other": np.array([row[2] for row in outputs], dtype=np.int64),
            "vector": np.array([row[3] for row in outputs], dtype=float).reshape(-1, 3),
            "total": np.array([row[4] for row in outputs], dtype=bool),
        },
        per_si=np.array([per_si(s.kind, s.unit, f"sensor {name!r}") for name, s in sensors]),
        alpha=np.array([model.materials[m.material].alpha for m in model.members.values()]),
        host=np.arange(len(members)),
        bearings=[],
        laws=[],
        nonlinear=model.analysis.geometry == "nonlinear",
    )
