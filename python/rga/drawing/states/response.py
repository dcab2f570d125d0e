"""What a structure does at given contexts."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.scene import Scene
from rga.drawing.states.contexts import context_words, settled, upper_ends
from rga.drawing.states.deformed import Deformed, deformed
from rga.drawing.states.diagrams import Diagram, Quantity, section_diagram
from rga.simulation import Results, Simulator, results

#: places along each member at which forces are drawn, where some member bends, and where none does
BENT, STRAIGHT = 21, 3
#: places along each member that are solved for: its ends, and the thirds that bowed members need
SOLVED = 4
#: members of a structure beyond which the places are fewer
MANY, FEW = 1000, 9


@dataclass(frozen=True)
class DrawnResponse:
    """The response of a structure as it is drawn.

    Attributes:
        deformed: its shape; None where it was not asked for.
        diagrams: of section forces.
        contexts: at which, in words.
        at: these contexts.
    """

    deformed: Deformed | None
    diagrams: tuple[Diagram, ...]
    contexts: str
    at: dict[str, float]


def drawn_response(
    scene: Scene,
    given: Mapping[str, float],
    quantities: Sequence[Quantity],
    scale: float | None = None,
    shape: bool = True,
) -> DrawnResponse:
    """Solve a structure, and make its shape and its diagrams.

    Contexts that are not given stand at mid-range. Where nothing happens there, under wind
    from either side say, they stand at the upper ends of their ranges, as those of loads do.

    Args:
        scene: the structure.
        given: contexts of one row.
        quantities: section forces.
        scale: by which displacements are enlarged; None: a round one that shows them.
        shape: the deformed shape is wanted.

    Raises:
        InputError: a context that the model does not have, or that is far from its range.
        UnstableStructureError: the structure can move; names node and direction.
    """
    found = results(scene.model, settled(scene.model, given), stations=SOLVED)
    if not (found.displacements.any() or found.section_forces.any()):
        found = results(scene.model, upper_ends(scene.model, given), stations=SOLVED)
    return response_of_row(scene, found, 0, quantities, scale, shape)


def response_of_row(
    scene: Scene,
    found: Results,
    row: int,
    quantities: Sequence[Quantity],
    scale: float | None = None,
    shape: bool = True,
) -> DrawnResponse:
    """The shape and the diagrams of one row of results.

    Args:
        scene: the structure.
        found: its results.
        row: number of the row, from 0.
        quantities, scale, shape: as for `drawn_response`.
    """
    model = scene.model
    diagrams: tuple[Diagram, ...] = ()
    if quantities:
        bent = FEW if len(scene.ends) > MANY else BENT
        stations = np.linspace(0.0, 1.0, bent if scene.frame.any() else STRAIGHT)
        positions, forces = _even(found.along.curves(row, stations))
        diagrams = tuple(section_diagram(scene, one, positions, forces) for one in quantities)
    contexts = {name: float(column[row]) for name, column in found.contexts.items()}
    return DrawnResponse(
        deformed=deformed(scene, found.displacements[row], scale) if shape else None,
        diagrams=diagrams,
        contexts=context_words(model, contexts, Simulator(model).needed),
        at=contexts,
    )


def _even(
    curves: Sequence[tuple[FloatArray, FloatArray]],
) -> tuple[FloatArray, FloatArray]:
    """Curves of as many places each, the last of them repeated.

    Returns:
        float[members, places] and float[members, places, 6].
    """
    longest = max(len(places) for places, _ in curves)
    chosen = [np.minimum(np.arange(longest), len(places) - 1) for places, _ in curves]
    return (
        np.stack([places[k] for (places, _), k in zip(curves, chosen, strict=True)]),
        np.stack([forces[k] for (_, forces), k in zip(curves, chosen, strict=True)]),
    )
