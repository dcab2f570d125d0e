"""What a drawing shows: what was asked for, worked out once for every view."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np

from rga.drawing.scene.loads import LoadMark, load_marks
from rga.drawing.scene.scene import Scene, make_scene
from rga.drawing.scene.sensors import SensorMark, sensor_marks
from rga.drawing.scene.supports import SpringMark, SupportMark, spring_marks, support_marks
from rga.drawing.states.contexts import context_words, settled
from rga.drawing.states.deformed import Deformed, deformed
from rga.drawing.states.diagrams import Diagram, Quantity, diagrams
from rga.drawing.states.response import axial_forces, node_displacements
from rga.errors import InputError
from rga.model.schema import Model
from rga.simulation import Simulator

#: what may be named
NAMED = ("nodes", "members", "sensors", "supports")


class DrawingOptions(TypedDict, total=False):
    """What may be asked of a drawing by name; `Selection` has the meanings."""

    names: str | Iterable[str]
    sensors: bool | None
    loads: Iterable[str] | None
    local_axes: bool
    deformed: bool
    scale: float | None
    forces: Quantity | None
    contexts: Mapping[str, float]
    dark: bool


@dataclass(frozen=True)
class Selection:
    """What is to be shown beside members and supports.

    Attributes:
        names: which parts are named, of "nodes", "members", "sensors" and "supports".
        sensors: None: unless a deformed shape or forces are drawn.
        loads: load effects by name; None: all of them, unless forces are drawn.
        local_axes: of the members.
        deformed: the deformed shape.
        scale: by which displacements are enlarged; None: a round one that shows them.
        forces: the diagram of a section force.
        contexts: at which all this is; those left out stand at mid-range.
        dark: for a dark background.
    """

    names: frozenset[str] = frozenset()
    sensors: bool | None = None
    loads: tuple[str, ...] | None = None
    local_axes: bool = False
    deformed: bool = False
    scale: float | None = None
    forces: Quantity | None = None
    contexts: Mapping[str, float] = field(default_factory=dict)
    dark: bool = False

    def __post_init__(self) -> None:
        if unknown := sorted(self.names - set(NAMED)):
            raise InputError(
                f"{unknown[0]!r} have no names to draw", "names", "choose of " + ", ".join(NAMED)
            )
        if self.scale is not None and not 0 < self.scale < np.inf:
            raise InputError(
                f"displacements cannot be enlarged by {self.scale:g}",
                "scale",
                "give a positive one",
            )


def asked(options: DrawingOptions) -> Selection:
    """What is to be shown, from the options of a call.

    Raises:
        InputError: names of what has none; a scale that is not positive.

    >>> asked({"names": "nodes"}).names
    frozenset({'nodes'})
    """
    names, loads = options.get("names", ()), options.get("loads")
    given = {
        **options,
        "names": frozenset([names] if isinstance(names, str) else names),
        "loads": None if loads is None else tuple(loads),
    }
    return Selection(**given)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Content:
    """A model with all that a drawing shows of it.

    Attributes:
        scene: the structure.
        shown: what was asked for.
        supports, springs, sensors, loads: their marks.
        deformed, diagram: None where they were not asked for.
    """

    scene: Scene
    shown: Selection
    supports: list[SupportMark]
    springs: list[SpringMark]
    sensors: list[SensorMark]
    loads: list[LoadMark]
    deformed: Deformed | None
    diagram: Diagram | None


def gather(model: Model, shown: Selection) -> Content:
    """Work out what a drawing shows.

    Raises:
        InputError: nothing to draw; an unknown load or context; a quantity that is not known.
        UnstableStructureError: a deformed shape or forces of a structure that can move.
    """
    scene = make_scene(model)
    contexts = settled(model, shown.contexts)
    state = shown.deformed or shown.forces is not None
    words = context_words(model, contexts, Simulator(model).needed) if state else ""
    shape, diagram = None, None
    if shown.deformed:
        moved = node_displacements(model, contexts)
        shape = deformed(scene, moved, words, shown.scale)
    if shown.forces is not None:
        diagram = _diagram(scene, shown.forces, contexts, words)
    with_sensors = not state if shown.sensors is None else shown.sensors
    chosen = () if shown.loads is None and shown.forces is not None else shown.loads
    # Beside a response stand the loads that bring it about, and no others.
    at = contexts if state else shown.contexts
    loads = load_marks(scene, chosen, at)
    return Content(
        scene=scene,
        shown=shown,
        supports=support_marks(scene),
        springs=spring_marks(scene),
        sensors=sensor_marks(scene, loads) if with_sensors else [],
        loads=loads,
        deformed=shape,
        diagram=diagram,
    )


def _diagram(
    scene: Scene, quantity: Quantity, contexts: Mapping[str, float], words: str
) -> Diagram:
    if quantity != "N":
        raise InputError(f"the section force {quantity!r} cannot be drawn", "forces", "choose N")
    positions = np.tile([0.0, 0.5, 1.0], (len(scene.ends), 1))
    return diagrams(
        scene, quantity, positions, axial_forces(scene.model, contexts, positions), words
    )
