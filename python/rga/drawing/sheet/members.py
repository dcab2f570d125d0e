"""Members, nodes, releases and local axes on a view."""

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.palette import group_look
from rga.drawing.scene.scene import Scene
from rga.drawing.sheet.canvas import Canvas

FRAME_WIDTH, BAR_WIDTH = 2.4, 1.5
#: nodes beyond which they have no symbols of their own
MOST_NODES = 600


def draw_members(canvas: Canvas, scene: Scene, faint: bool = False) -> None:
    """Members in the colours of their groups, those that bend thicker.

    Args:
        faint: they step back behind something else.
    """
    shown = canvas.view.members
    places = canvas.inches(scene.points)[scene.ends]
    canvas.avoid(places[shown])
    frame = scene.frame
    thin = 0.6 if len(shown) > 4 * MOST_NODES else 1.0
    for number in np.unique(scene.group[shown]):
        colour, dashes = group_look(canvas.palette, int(number))
        for bends, width in ((0, BAR_WIDTH), (1, FRAME_WIDTH)):
            chosen = shown[(scene.group[shown] == number) & (frame[shown] == bends)]
            look = (canvas.palette.faint, 0.9) if faint else (colour, width * thin)
            style = (0, dashes) if dashes and not faint else "solid"
            canvas.lines(places[chosen], *look, zorder=2, linestyles=[style])
    if not faint and len(canvas.view.nodes) <= MOST_NODES:
        _nodes(canvas, scene)
        _releases(canvas, scene, places)


def draw_local_axes(canvas: Canvas, scene: Scene) -> None:
    """Local x, y and z of every member at its middle."""
    middles = canvas.inches(scene.points[scene.ends].mean(axis=1))
    for member in canvas.view.members:
        at = middles[member]
        for axis, colour, name in zip(scene.axes[member], canvas.palette.axes, "xyz", strict=True):
            along = canvas.direction(axis)
            if np.linalg.norm(along) < 0.15:
                continue
            tip = at + 0.24 * along
            canvas.lines([np.array([at, tip])], colour, 1.0, zorder=6)
            canvas.text(name, at + 0.3 * along, colour, fontsize=6, ha="center", va="center")


def _nodes(canvas: Canvas, scene: Scene) -> None:
    """A ring where all members are hinged, a dot where some are joined stiffly."""
    stiff = np.zeros(len(scene.points), dtype=bool)
    for member, one in zip(scene.ends, scene.model.members.values(), strict=True):
        if one.kind == "frame":
            for node, released in zip(member, (one.releases.i, one.releases.j), strict=True):
                stiff[node] |= not {"ry", "rz"} & set(released)
    places = canvas.inches(scene.points)
    for chosen, face in ((stiff, canvas.palette.ink), (~stiff, canvas.palette.paper)):
        shown = places[[node for node in canvas.view.nodes if chosen[node]]] * canvas.unit
        canvas.axes.plot(
            *shown.T, "o", markersize=3.0, mfc=face, mec=canvas.palette.ink, mew=0.7, zorder=4
        )
    for node in canvas.view.nodes:
        canvas.keep_clear(places[node], 0.03)


def _releases(canvas: Canvas, scene: Scene, places: FloatArray) -> None:
    """A ring where an end may turn, grey where a spring resists; bars across where it may slip."""
    every = list(scene.model.members.values())
    rings: dict[str, list[FloatArray]] = {canvas.palette.paper: [], canvas.palette.faint: []}
    bars = []
    for member in canvas.view.members:
        one = every[member]
        if one.kind != "frame":
            continue
        first, last = places[member]
        length = float(np.linalg.norm(last - first))
        if length == 0:
            continue
        along = (last - first) / length
        across = np.array([-along[1], along[0]])
        away = min(0.1, 0.25 * length)
        for at, released, springs in (
            (first + away * along, one.releases.i, one.end_springs.i),
            (last - away * along, one.releases.j, one.end_springs.j),
        ):
            if {"ry", "rz"} & set(released):
                rings[canvas.palette.paper].append(at)
            elif springs:
                rings[canvas.palette.faint].append(at)
            if {"ux", "uy", "uz"} & set(released):
                bars += [
                    np.array([at + k * along - 0.05 * across, at + k * along + 0.05 * across])
                    for k in (-0.015, 0.015)
                ]
    for face, points in rings.items():
        if points:
            canvas.axes.plot(
                *(np.array(points) * canvas.unit).T, "o", markersize=4.2, mfc=face,
                mec=canvas.palette.ink, mew=0.9, zorder=5,
            )  # fmt: skip
    canvas.lines(bars, canvas.palette.ink, 0.9, zorder=5)
