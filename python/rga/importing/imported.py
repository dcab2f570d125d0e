"""What importing gives."""

from dataclasses import dataclass, field

from rga.importing.notes import ImportNote
from rga.model import Model


@dataclass(frozen=True)
class ImportedModel:
    """A model of another program, and what its reader says.

    Attributes:
        model: the model.
        notes: all that was dropped, assumed or noticed, gravest first.
        counts: how many parts it has, by kind.
        load_sums: the sum of the forces of each load case in the model's axes [N], factors and all.
    """

    model: Model
    notes: list[ImportNote] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    load_sums: dict[str, tuple[float, float, float]] = field(default_factory=dict)
