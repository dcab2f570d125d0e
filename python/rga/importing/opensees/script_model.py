"""What an OpenSees script defines, in its own units and axes, before it becomes a model."""

from dataclasses import dataclass, field

from rga.importing.scripts.values import Arguments

#: degrees of freedom of a node, by dimensions of space and their number
FREEDOMS = {
    (2, 2): ("ux", "uy"),
    (2, 3): ("ux", "uy", "rz"),
    (3, 3): ("ux", "uy", "uz"),
    (3, 6): ("ux", "uy", "uz", "rx", "ry", "rz"),
}


@dataclass(frozen=True)
class Defined:
    """Something under a tag: its kind, its numbers by name, and where it stands."""

    kind: str
    values: dict[str, float]
    where: str


@dataclass(frozen=True)
class Node:
    """A node: where it is, and its degrees of freedom."""

    place: tuple[float, ...]
    freedoms: tuple[str, ...]
    where: str


@dataclass(frozen=True)
class Element:
    """An element that can be a member or springs.

    Attributes:
        kind: "truss", "frame" or "springs".
        values: section and material properties by name; of springs, stiffness by direction.
        transformation: the tag of that of a frame member.
        released: local degrees of freedom that its ends do not pass on.
        materials: tags of materials that it names, with the property that each gives.
    """

    kind: str
    command: str
    nodes: tuple[str, str]
    where: str
    values: dict[str, float] = field(default_factory=dict)
    materials: tuple[tuple[str, str], ...] = ()
    section: str | None = None
    transformation: str | None = None
    released: dict[str, list[str]] = field(default_factory=dict)


@dataclass(frozen=True)
class NodalForces:
    """A load at a node: its components, by the node's degrees of freedom."""

    pattern: str
    node: str
    components: tuple[float, ...]
    where: str


@dataclass(frozen=True)
class ElementLoad:
    """A load along elements: uniform [wx, wy, wz], or a point load and its share of the length."""

    pattern: str
    elements: tuple[str, ...]
    where: str
    components: tuple[float, float, float]
    at: float | None = None


@dataclass(frozen=True)
class Moved:
    """A degree of freedom that a pattern moves: of a node, numbered from 1."""

    pattern: str
    node: str
    freedom: int
    by: float
    where: str


@dataclass(frozen=True)
class PatternCommand:
    """A load pattern: its kind, the tag or kind of its series, and its factor."""

    kind: str
    series: str
    factor: float
    where: str


@dataclass
class ScriptModel:
    """All that one model of a script defines, by tag; `refusals` are what no model can have.

    Attributes:
        unread: commands that this reader does not know: words and place.
    """

    dimensions: int = 2
    freedoms: tuple[str, ...] = ()
    where: str = ""
    nodes: dict[str, Node] = field(default_factory=dict)
    elements: dict[str, Element] = field(default_factory=dict)
    materials: dict[str, Defined] = field(default_factory=dict)
    sections: dict[str, Defined] = field(default_factory=dict)
    transformations: dict[str, Defined] = field(default_factory=dict)
    integrations: dict[str, tuple[str, int]] = field(default_factory=dict)
    series: dict[str, Defined] = field(default_factory=dict)
    patterns: dict[str, PatternCommand] = field(default_factory=dict)
    fixes: list[tuple[str, tuple[str, ...], str]] = field(default_factory=list)
    masses: dict[str, tuple[tuple[float, ...], str]] = field(default_factory=dict)
    ties: list[tuple[str, str, tuple[int, ...], str]] = field(default_factory=list)
    forces: list[NodalForces] = field(default_factory=list)
    element_loads: list[ElementLoad] = field(default_factory=list)
    moved: list[Moved] = field(default_factory=list)
    refusals: list[tuple[str, str]] = field(default_factory=list)
    dropped: list[tuple[str, str]] = field(default_factory=list)

    def node(self, tag: str, given: Arguments) -> Node:
        """The node of a tag.

        Raises:
            InputError: there is none.
        """
        if tag not in self.nodes:
            raise given.error(f"there is no node {tag} before it")
        return self.nodes[tag]

    def refuse(self, given: Arguments, what: str) -> None:
        """ImportNote what would make the model wrong."""
        self.refusals.append((given.where, what))
