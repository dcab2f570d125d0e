"""Parts of a structure, as a model file states them."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from rga.model.parameter import AboveZero, NotNegative, Number
from rga.no_booleans import NO_BOOLEAN

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
Dof = Literal["ux", "uy", "uz", "rx", "ry", "rz"]
Vector = tuple[Number, Number, Number]


class Part(BaseModel):
    """A part of a model file: unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class About(Part):
    """Whom and what a model is for: the head of its reports.

    Attributes:
        client, structure, author, date, version: as they are to be printed.
    """

    client: str = ""
    structure: str = ""
    author: str = ""
    date: str = ""
    version: str = ""


class Material(Part):
    """E [Pa], nu [-], alpha [1/K], density [kg/m3].

    Attributes:
        yield_strength: [Pa]; stresses are set against it where it is given.
    """

    E: AboveZero
    nu: Annotated[float, Field(gt=-1, lt=0.5), NO_BOOLEAN] = 0.3
    alpha: Number = 0.0
    density: NotNegative = 0.0
    yield_strength: AboveZero | None = None


class Section(Part):
    """A [m2], second moments Iy and Iz [m4], torsion constant J [m4], shear areas [m2].

    Attributes:
        fibres: local y and z [m] of the points whose stresses are of interest, by name.
    """

    A: AboveZero
    Iy: NotNegative = 0.0
    Iz: NotNegative = 0.0
    J: NotNegative = 0.0
    Asy: AboveZero | None = None
    Asz: AboveZero | None = None
    fibres: dict[str, tuple[Number, Number]] = {}


class Ends(Part):
    """What each end of a member has: `i` is its first node, `j` its second."""

    @model_validator(mode="before")
    @classmethod
    def _named(cls, given: Any) -> Any:
        if isinstance(given, Mapping) and (
            others := [end for end in given if end not in cls.model_fields]
        ):
            raise ValueError(
                f"{others[0]!r} is no end of a member: i is that at its first node, j at its second"
            )
        return given


class Releases(Ends):
    """Degrees of freedom that the member does not pass on at its ends, in local axes."""

    i: list[Dof] = []
    j: list[Dof] = []


class EndSprings(Ends):
    """Stiffness of the connection of the member's ends, in local axes [N m/rad or N/m]."""

    i: dict[Dof, AboveZero] = {}
    j: dict[Dof, AboveZero] = {}


class Member(Part):
    """A straight member between two nodes: `truss` (axial) or `frame`."""

    nodes: tuple[str, str]
    section: str
    material: str
    kind: Literal["truss", "frame"] = "truss"
    groups: list[str] = []
    local_y: Vector | None = None
    releases: Releases = Releases()
    end_springs: EndSprings = EndSprings()


class Support(Part):
    """A support: fixed degrees of freedom of a node, or the direction in which it is held."""

    node: str
    fixed: list[Dof] = []
    along: Vector | None = None


class Spring(Part):
    """A spring from a node to the ground, or between two nodes [N/m or N m/rad]."""

    node: str
    to: str | None = None
    dof: Dof
    stiffness: AboveZero


class Tie(Part):
    """Two nodes that share the degrees of freedom named."""

    nodes: tuple[str, str]
    dofs: list[Dof]


class Mass(Part):
    """What moves with the structure beside the members themselves; statics has no use for it.

    Attributes:
        node, mass: a mass on a node [kg].
        inertia: of that mass, about the global axes [kg m2].
        group, per_length: a mass along the members of groups [kg/m].
    """

    node: str | None = None
    mass: NotNegative | None = None
    inertia: tuple[NotNegative, NotNegative, NotNegative] = (0.0, 0.0, 0.0)
    group: str | list[str] | None = None
    per_length: NotNegative | None = None

    @model_validator(mode="after")
    def _on_a_node_or_along_members(self) -> "Mass":
        on_node = self.node is not None and self.mass is not None
        along = self.group is not None and self.per_length is not None
        given = self.model_fields_set
        of_node, of_group = given & {"node", "mass", "inertia"}, given & {"group", "per_length"}
        if (on_node and not of_group) or (along and not of_node):
            return self
        raise ValueError(
            "a mass is on a node (give node and mass [kg]) or along the members of a group (give "
            "group and per_length [kg/m])"
        )
