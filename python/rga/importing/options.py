"""What a user chooses about a file that is read."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Literal

from rga.importing.notes import Acceptance
from rga.importing.units import Units

Properties = Mapping[str, float]


@dataclass(frozen=True)
class Chosen:
    """Options of a reader; each reads those that its files need.

    Attributes:
        units: of the file, as the user has them: "kip, in"; of a drawing, "mm".
        up: the axis of the file that points up.
        plane: of a model whose file has all nodes in it, and which is to be one of that plane.
        accept: what the user accepts: "linear", "partial", "values".
        without: files that a script reads and that are not needed.
        materials, sections: given by hand, by the name of the file's; None: of all others.
        kind: of members that a drawing has.
        tolerance: below which points of a drawing are one [m]; None: by its size.
        combination: of load cases, whose factors they get.
    """

    units: str | None = None
    up: Literal["y", "z"] | None = None
    plane: Literal["xy", "xz", "yz"] | None = None
    accept: Collection[Acceptance] = ()
    without: Collection[str] = ()
    materials: Mapping[str | None, Properties] = field(default_factory=dict)
    sections: Mapping[str | None, Properties] = field(default_factory=dict)
    kind: Literal["truss", "frame"] | None = None
    tolerance: float | None = None
    combination: str | None = None

    @property
    def system(self) -> Units | None:
        """The system of units; None where none is given."""
        return None if self.units is None else Units.read(self.units, "--units")
