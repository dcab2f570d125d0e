"""What a drawing shows: what was asked for, worked out once for every view."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np

from rga.drawing.scene.loads import LoadMark, load_marks
from rga.drawing.scene.scene import Scene, make_scene
from rga.drawing.scene.sensors import SensorMark, sensor_marks
from rga.drawing.scene.supports import SpringMark, SupportMark, spring_marks, support_marks
from rga.drawing.states.diagrams import QUANTITIES, Quantity
from rga.drawing.states.response import DrawnResponse, drawn_response, response_of_row
from rga.errors import InputError, kind_of
from rga.model.schema import Model
from rga.simulation import Results

#: what may be named, and the word for all of it
NAMED, ALL = ("nodes", "members", "sensors", "supports"), "all"


class DrawingOptions(TypedDict, total=False):
    """What may be asked of a drawing by name; `Selection` has the meanings."""

    names: str | Iterable[str]
    sensors: bool | None
    loads: str | Iterable[str] | None
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
        names: which parts are named, of "nodes", "members", "sensors" and "supports"; a call may
            say "all".
        sensors: None: unless a deformed shape or forces are drawn.
        loads: load effects by name; None: all of them, unless forces are drawn.
        local_axes: of the members.
        deformed: the deformed shape.
        scale: by which displacements are enlarged; None: a round one that shows them.
        forces: the diagram of a section force, of `QUANTITIES`.
        contexts: at which all this is; those left out stand at mid-range, or where nothing happens
            there at the upper ends of their ranges.
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
                f"{unknown[0]!r} have no names to draw",
                "names",
                "choose of " + ", ".join((*NAMED, ALL)),
            )
        if self.forces not in (None, *QUANTITIES):
            raise InputError(
                f"there is no section force {self.forces!r}",
                "forces",
                "choose of " + ", ".join(QUANTITIES),
            )
        if self.scale is not None and not 0 < self.scale < np.inf:
            raise InputError(
                f"displacements cannot be enlarged by {self.scale:g}",
                "scale",
                "give a positive one",
            )

    @property
    def of_response(self) -> bool:
        """Whether the structure has to be solved."""
        return self.deformed or self.forces is not None


def asked(options: DrawingOptions) -> Selection:
    """What is to be shown, from the options of a call.

    Raises:
        InputError: an unknown option; names of what has none; a scale that is not positive.

    >>> asked({"names": "nodes"}).names
    frozenset({'nodes'})
    """
    known = DrawingOptions.__annotations__
    if unknown := [name for name in options if name not in known]:
        raise InputError(
            f"a drawing has no option {unknown[0]!r}", "options", "choose of " + ", ".join(known)
        )
    named, loads = _several(options.get("names", ()), "names"), options.get("loads")
    given = {
        **options,
        "names": frozenset(NAMED if ALL in named else named),
        "loads": None if loads is None else _several(loads, "loads"),
    }
    return Selection(**given)  # type: ignore[arg-type]


def _several(given: str | Iterable[str], option: str) -> tuple[str, ...]:
    """One name or several."""
    if isinstance(given, str):
        return (given,)
    if not isinstance(given, Iterable):
        raise InputError(f"{kind_of(given)} names nothing", option, "give a name, or several")
    return tuple(given)


@dataclass(frozen=True)
class Content:
    """A model with all that a drawing shows of it.

    Attributes:
        scene: the structure.
        shown: what was asked for.
        supports, springs, sensors, loads: their marks.
        response: None where neither a deformed shape nor forces were asked for.
    """

    scene: Scene
    shown: Selection
    supports: list[SupportMark]
    springs: list[SpringMark]
    sensors: list[SensorMark]
    loads: list[LoadMark]
    response: DrawnResponse | None


def gather(model: Model, shown: Selection, found: Results | None = None, row: int = 0) -> Content:
    """Work out what a drawing shows.

    Args:
        model: the model.
        shown: what was asked for.
        found: results of the model; None: those at the contexts that were asked for.
        row: of these results, from 0.

    Raises:
        InputError: nothing to draw; an unknown load or context.
        UnstableStructureError: a deformed shape or forces of a structure that can move.
    """
    scene = make_scene(model)
    quantities = [] if shown.forces is None else [shown.forces]
    response = None
    if found is not None:
        response = response_of_row(scene, found, row, quantities, shown.scale, shown.deformed)
    elif shown.of_response:
        response = drawn_response(scene, shown.contexts, quantities, shown.scale, shown.deformed)
    with_sensors = not shown.of_response if shown.sensors is None else shown.sensors
    chosen = () if shown.loads is None and shown.forces is not None else shown.loads
    # Beside a response stand the loads that bring it about, and no others.
    loads = load_marks(scene, chosen, shown.contexts if response is None else response.at)
    return Content(
        scene=scene,
        shown=shown,
        supports=support_marks(scene),
        springs=spring_marks(scene),
        sensors=sensor_marks(scene, loads) if with_sensors else [],
        loads=loads,
        response=response,
    )
