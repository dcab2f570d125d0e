"""Diagrams of section forces along members."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.drawing.scene.scene import Scene
from rga.simulation.structural_results import SECTION_FORCES

Quantity = Literal["N", "V", "M", "T", "Vy", "Vz", "My", "Mz"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
SIGNS: dict[Quantity, tuple[str, str]] = {"N": ("tension", "compression")}
WORDS: dict[Quantity, str] = {
    "N": "axial force N, tension positive",
    "V": "shear force V",
    "M": "bending moment M on the side in tension",
    "T": "torsion T",
    "Vy": "shear force Vy",
    "Vz": "shear force Vz",
    "My": "bending moment My on the side in tension",
    "Mz": "bending moment Mz on the side in tension",
}
#: local axis, y or z, on whose side positive values stand, and its sign: My stretches the fibres at
#: +z, Mz those at -y
SIDES: dict[str, tuple[int, float]] = {
    "N": (2, 1.0), "T": (2, 1.0), "Vy": (1, 1.0), "Vz": (2, 1.0), "My": (2, 1.0), "Mz": (1, -1.0)
}  # fmt: skip

#: shares of the largest value: of a difference that is none, and of a value that is seldom told
EVEN, SMALL = 1e-6, 0.1


@dataclass(frozen=True)
class Diagram:
    """Values of a section force along members.

    Attributes:
        quantity: which.
        positions: of the stations, as shares of each member's length, float[members, stations].
        values: there [N or N m], float[members, stations].
        sides: towards which positive values are drawn, float[members, 3].
        bends: whether some member is no bar, which has N alone.
    """

    quantity: Quantity
    positions: FloatArray
    values: FloatArray
    sides: FloatArray
    bends: bool

    @property
    def largest(self) -> float:
        """The largest value, regardless of its sign; 0 where all are none."""
        return float(np.abs(self.values).max(initial=0.0))

    def told(self, member: int) -> list[int]:
        """Places whose values are written, the largest first: ends, extremes, both sides of jumps.

        Of what is the same all along it is the middle. What is small beside the largest value of
        the diagram is written where it is the largest of its member alone.
        """
        values, places = self.values[member], self.positions[member]
        sizes, steps = np.abs(values), np.abs(np.diff(values))
        if np.ptp(values) <= EVEN * self.largest:
            return [int(np.argmin(np.abs(places - 0.5)))]
        jumps = np.flatnonzero((np.diff(places) == 0) & (steps > EVEN * self.largest)).tolist()
        extremes = [int(np.argmin(values)), int(np.argmax(values))]
        found = {0, len(values) - 1, *extremes, *jumps, *(place + 1 for place in jumps)}
        order = sorted(found, key=lambda place: (-sizes[place], place))
        return order[:1] + [place for place in order[1:] if sizes[place] >= SMALL * self.largest]

    @property
    def unit(self) -> str:
        """Of the values."""
        return "N m" if self.quantity[0] in "MT" else "N"


def section_diagram(
    scene: Scene, quantity: Quantity, positions: FloatArray, forces: FloatArray
) -> Diagram:
    """A diagram along members, drawn across them.

    V and M of a plane structure are those in its plane, and of one in space Vz and My. Moments
    stand on the side that they stretch.

    Args:
        scene: the structure.
        quantity: which section force.
        positions: of the stations as shares of each member's length, float[members, stations].
        forces: N, Vy, Vz [N], T, My, Mz [N m] there, float[members, stations, 6].
    """
    component, signs = _components(scene, quantity)
    members = np.arange(len(forces))
    values = forces[members, :, component]
    axis = np.array([SIDES[name][0] for name in SECTION_FORCES])[component]
    sides = signs[:, None] * scene.axes[members, axis]
    return Diagram(quantity, positions, values, sides, bends=bool(scene.frame.any()))


def _components(scene: Scene, quantity: Quantity) -> tuple[IntArray, FloatArray]:
    """Of every member the number of the component, and the sign of its side."""
    names = [quantity] * len(scene.ends)
    if quantity in ("V", "M"):
        across = np.zeros(len(scene.ends), dtype=bool)
        if scene.normal is not None:
            # Local y lies in the plane where local z does not.
            out = np.abs(scene.axes[:, 1:] @ scene.normal)
            across = out[:, 1] > out[:, 0]
        in_y, in_z = ("Vy", "Vz") if quantity == "V" else ("Mz", "My")
        names = [in_y if one else in_z for one in across]  # type: ignore[misc]
    numbers = np.array([SECTION_FORCES.index(name) for name in names], dtype=np.int64)
    return numbers, np.array([SIDES[name][1] for name in names])
