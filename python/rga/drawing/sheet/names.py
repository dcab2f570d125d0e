"""Names of parts on a view, where there is room for them."""

from collections.abc import Iterator, Mapping

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.content import Content
from rga.drawing.label import label
from rga.drawing.labels import LETTER
from rga.drawing.scene.scene import MOST_NAMED
from rga.drawing.sheet.canvas import Canvas

#: letters of a name that are drawn
LONGEST = 18
#: distance at which a label has a line to its place [inch]
FAR = 0.16


def draw_names(canvas: Canvas, content: Content, sensors: Mapping[str, FloatArray]) -> int:
    """Write the names that were asked for.

    Args:
        sensors: where their symbols stand [inch].

    Returns:
        How many found no room.
    """
    missed = 0
    for kind, look, width in (
        ("sensors", {"weight": "bold", "fontsize": 6.3}, 0.1),
        ("supports", {"fontsize": 6.3}, 0.26),
        ("nodes", {"fontsize": 6.6}, 0.06),
        ("members", {"style": "italic", "fontsize": 6.3}, 0.03),
    ):
        if kind not in content.shown.names:
            continue
        places = list(_places(canvas, content, kind, sensors))
        if len(places) > MOST_NAMED:
            missed += len(places)
            continue
        # A member is long and hides what leads to its middle: its name must stand by itself.
        rivals = np.array([at for _, at in places]) if kind == "members" else None
        colour = canvas.palette.steel if kind == "members" else canvas.palette.ink
        for name, at in places:
            letter = LETTER * (1.15 if "weight" in look else 1.0)
            placed = canvas.room.place(label(name, LONGEST), at, width, letter, rivals=rivals)
            if placed is None:
                missed += 1
                continue
            left, bottom, right, top = placed.box
            near = np.clip(at, (left, bottom), (right, top))
            if np.linalg.norm(near - at) > FAR:
                canvas.lines([np.array([at, near])], canvas.palette.steel, 0.6, zorder=8)
            canvas.text(
                placed.text,
                (left, bottom),
                colour,
                va="bottom",
                **look,
            )
    return missed


def _places(
    canvas: Canvas, content: Content, kind: str, sensors: Mapping[str, FloatArray]
) -> Iterator[tuple[str, FloatArray]]:
    scene = content.scene
    points = canvas.inches(scene.points)
    if kind == "sensors":
        yield from sensors.items()
    elif kind == "nodes":
        names = list(scene.nodes)
        yield from ((names[node], points[node]) for node in canvas.view.nodes)
    elif kind == "members":
        names = list(scene.members)
        for member in canvas.view.members:
            yield names[member], points[scene.ends[member]].mean(axis=0)
    else:
        shown = set(canvas.view.nodes.tolist())
        for mark in content.supports:
            if mark.node in shown:
                yield mark.name, points[mark.node] - np.array([0.0, 0.1])
