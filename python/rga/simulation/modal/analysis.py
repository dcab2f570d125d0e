"""Natural frequencies and mode shapes of a model."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.files import write_table
from rga.model import as_model
from rga.model.schema import DOFS, Model
from rga.notebook import short_html
from rga.provenance import versions
from rga.quantities import counted
from rga.simulation.contexts import Contexts
from rga.simulation.modal.points import STILL
from rga.simulation.modal.structures import ModalStructures, computed_modes

#: modes that may be asked for
MOST = 1000
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Modes:
    """Modes of a structure, the lowest first.

    Attributes:
        model: the model.
        frequencies: [Hz], float[modes].
        shapes: ux, uy, uz [m], rx, ry, rz [rad] of the nodes, float[modes, nodes, 6], with a modal
            mass of 1 kg; the largest motion is positive.
        mass: that moves along x, y and z [kg], float[3], that of held nodes included.
        participating: share of it that follows a shaking of the ground along x, y, z in each mode,
            float[modes, 3] (Chopra, Dynamics of Structures, 2012, section 13.2).
    """

    model: Model
    frequencies: FloatArray
    shapes: FloatArray
    mass: FloatArray
    participating: FloatArray

    def to_frame(self) -> pl.DataFrame:
        """One line a mode: mode, f [Hz], share of the mass along x, y, z [-], most at, most along.

        `most at` and `most along` say which node moves most, and along which axis; they are empty
        where all nodes stand still, and members between them move.
        """
        moving = np.abs(self.shapes[:, :, :3]).reshape(len(self.shapes), -1)
        # The whole mass moves by this much at a modal mass of 1 kg.
        together = 1.0 / np.sqrt(max(float(self.mass.max()), np.finfo(float).tiny))
        names = list(self.model.nodes)
        most = [
            divmod(int(one.argmax()), 3) if one.max() > STILL * together else None for one in moving
        ]
        return pl.DataFrame(
            {
                "mode": np.arange(1, len(self.frequencies) + 1),
                "f": self.frequencies,
                **{f"mass {name}": self.participating[:, at] for at, name in enumerate(AXES)},
                "most at": [None if at is None else names[at[0]] for at in most],
                "most along": [None if at is None else AXES[at[1]] for at in most],
            },
            schema_overrides={"most at": pl.String, "most along": pl.String},
        )

    def shapes_to_frame(self) -> pl.DataFrame:
        """All shapes in one table: mode, node, dof, value."""
        modes, nodes = len(self.shapes), list(self.model.nodes)
        return pl.DataFrame(
            {
                "mode": np.repeat(np.arange(1, modes + 1), len(nodes) * 6),
                "node": np.tile(np.repeat(nodes, 6), modes),
                "dof": np.tile(DOFS, modes * len(nodes)),
                "value": self.shapes.ravel(),
            }
        )

    def content(self) -> dict[str, Any]:
        """What is told of the modes, as JSON takes it: all but their shapes."""
        return {
            "rga_modes": 1,
            "model": {"name": self.model.name, "sha256": self.model.sha256},
            "mass": dict(zip(AXES, self.mass.tolist(), strict=True)),
            "modes": self.to_frame().to_dicts(),
            "versions": versions(),
        }

    def write(self, path: str | Path) -> None:
        """Write the table of `shapes_to_frame` as CSV or Parquet.

        Raises:
            InputError: another format, or a place that cannot be written to.
        """
        write_table(self.shapes_to_frame(), path)

    def _repr_html_(self) -> str:
        return short_html(
            self.model.name, f"{counted(len(self.frequencies), 'mode')}", self.to_frame()
        )

    def __repr__(self) -> str:
        frequencies = ", ".join(f"{one:.4g}" for one in self.frequencies[:6])
        more = ", ..." if len(self.frequencies) > 6 else ""
        return f"Modes of {self.model.name!r}: {frequencies}{more} Hz"


def modes(model: Model | str | Path, count: int = 10, contexts: Contexts | None = None) -> Modes:
    """Natural frequencies and mode shapes: the lowest, none of which is missed.

    Members move with their density and what `masses` state along them, consistent with the shapes
    in which they deform; loads have no mass.

    Args:
        model: the structure with its effects, or its file.
        count: of modes; there are fewer where few parts have a mass.
        contexts: one row, as for `results`; None for a model whose structure none drives.

    Raises:
        InputError: as `results`; nothing has a mass, or the structure is not linear: friction, play
            or slack leave no frequency of its own.
        UnstableStructureError: the structure can move; names node and direction.

    >>> import rga
    >>> mast = rga.ModelBuilder("mast").add_material("steel", "S355").add_section("mast", "HEB 200")
    >>> mast = mast.add_node("foot").add_node("head", z="6 m").support("foot", "fixed")
    >>> mast = mast.add_member("foot", "head", "mast", kind="frame").mass("head", "500 kg")
    >>> rga.modes(mast.build(), 2)
    Modes of 'mast': 1.588, 2.678 Hz
    """
    model = as_model(model)
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MOST:
        raise InputError(f"there cannot be {count!r} modes", "modes", f"give 1 to {MOST}")
    structure = ModalStructures(model).one_under(contexts)
    frequencies, shapes, participation, mass = computed_modes(structure, count)
    with np.errstate(divide="ignore", invalid="ignore"):
        participating = np.where(mass > 0, participation**2 / mass, 0.0)
    # Nodes that effects have added are none of the model.
    return Modes(model, frequencies, shapes[:, : len(model.nodes)], mass, participating)
