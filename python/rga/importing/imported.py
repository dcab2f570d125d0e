"""What importing gives."""

from dataclasses import dataclass, field

import numpy as np

from rga.importing.notes import Note
from rga.model import Model
from rga.model.axes import member_axes


@dataclass(frozen=True)
class ImportedModel:
    """A model of another program, and what its reader says.

    Attributes:
        model: the model.
        notes: all that was dropped, assumed or noticed, gravest first.
        counts: how many parts it has, by kind.
    """

    model: Model
    notes: list[Note] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)

    @property
    def load_sums(self) -> dict[str, tuple[float, float, float]]:
        """The sum of the forces of each load [N], in the model's axes, with their factors."""
        sums: dict[str, tuple[float, float, float]] = {}
        for name, effect in self.model.effects.items():
            given = effect.model_dump()
            total = np.zeros(3)
            if given["kind"] == "nodal_load":
                total = np.sum([force[:3] for force in given["forces"].values()], axis=0)
            elif given["kind"] == "member_load":
                for member in given["member"]:
                    length, axes = member_axes(self.model, member)
                    total = total + _along(given, length) @ axes
            else:
                continue
            x, y, z = (float(value) for value in given["factor"] * total)
            sums[name] = (x, y, z)
        return sums


def _along(load: dict[str, object], length: float) -> np.ndarray:
    """The sum of a load along a member in its local axes, float[3] [N]."""
    if load["uniform"] is not None:
        return np.array(load["uniform"]) * length
    if load["point"] is not None:
        return np.array(load["point"])
    x1, x2, w1, w2 = load["trapezoid"]  # type: ignore[misc]
    return np.eye(3)["xyz".index(str(load["axis"]))] * (w1 + w2) / 2 * (x2 - x1)
