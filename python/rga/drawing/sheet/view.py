"""One view of a structure with all that is to be shown of it."""

import numpy as np
from matplotlib.axes import Axes

from rga.arrays import FloatArray
from rga.drawing.content import Content
from rga.drawing.palette import DARK, LIGHT, Palette
from rga.drawing.sheet.canvas import Canvas, canvas_in
from rga.drawing.sheet.loads import draw_loads
from rga.drawing.sheet.members import draw_local_axes, draw_members
from rga.drawing.sheet.names import draw_names
from rga.drawing.sheet.sensors import draw_sensors
from rga.drawing.sheet.springs import draw_masses, draw_springs, draw_ties
from rga.drawing.sheet.states import curved_points, draw_deformed, draw_diagram
from rga.drawing.sheet.supports import draw_supports
from rga.drawing.views import View
from rga.quantities import short

#: around the members: supports; more for arrows and sensors, and for names [inch]
MARGIN, FOR_ARROWS, FOR_NAMES = 0.32, 0.2, 0.12


def palette_of(content: Content) -> Palette:
    """The colours that were asked for."""
    return DARK if content.shown.dark else LIGHT


def margin_of(content: Content) -> float:
    """Room for symbols around the members of a view [inch]."""
    forces = content.shown.forces is not None
    arrows = bool(content.loads or content.sensors or forces)
    return MARGIN + FOR_ARROWS * arrows + FOR_NAMES * bool(content.shown.names)


def seen(content: Content, view: View) -> FloatArray:
    """Points that a view must hold, float[k, 3] [m]."""
    scene = content.scene
    parts = [scene.points[view.nodes]]
    response = content.response
    if response is not None and response.deformed is not None:
        parts.append(curved_points(scene, response.deformed)[view.members].reshape(-1, 3))
    return np.vstack(parts)


def draw_view(axes: Axes, content: Content, view: View) -> dict[str, int]:
    """Draw one view into axes, as large as they are.

    Returns:
        How many labels found no room: "value" of forces, "name".
    """
    palette = palette_of(content)
    canvas = canvas_in(axes, view, seen(content, view), margin_of(content), palette)
    scene = content.scene
    draw_members(canvas, scene, faint=content.response is not None)
    draw_supports(canvas, content.supports, scene)
    draw_springs(canvas, content.springs, scene)
    draw_ties(canvas, scene)
    draw_masses(canvas, scene)
    values = 0
    if content.response is not None:
        for diagram in content.response.diagrams:
            values += draw_diagram(canvas, scene, diagram)
        if content.response.deformed is not None:
            draw_deformed(canvas, scene, content.response.deformed)
    draw_loads(canvas, content.loads, scene)
    placed = draw_sensors(canvas, content.sensors)
    if content.shown.local_axes:
        draw_local_axes(canvas, scene)
    _foot(canvas)
    return {"value": values, "name": draw_names(canvas, content, placed)}


def _foot(canvas: Canvas) -> None:
    """The scale as a bar, and the global axes."""
    left, right = (edge / canvas.unit for edge in canvas.axes.get_xlim())
    bottom = canvas.axes.get_ylim()[0] / canvas.unit
    wide = right - left
    longest = min(1.6, 0.3 * wide) * canvas.unit
    power = 10.0 ** np.floor(np.log10(longest))
    metres = power * next(step for step in (5, 2, 1) if step * power <= longest * (1 + 1e-9))
    x, y = left + 0.75, bottom + 0.14
    bar = np.array([[x, y], [x + metres / canvas.unit, y]])
    tick = np.array([0.0, 0.035])
    ends = [np.array([end - tick, end + tick]) for end in bar]
    canvas.lines([bar, *ends], canvas.palette.ink, 0.9, zorder=6)
    canvas.text(f"{short(float(metres))} m", bar[1] + (0.07, 0.0), canvas.palette.ink, va="center")
    origin = np.array([left + 0.2, bottom + 0.12])
    for axis, name in zip(np.eye(3), "xyz", strict=True):
        along = canvas.direction(axis)
        if np.linalg.norm(along) < 0.2:
            continue
        tip = origin + 0.24 * along
        canvas.lines([np.array([origin, tip])], canvas.palette.steel, 0.9, zorder=6)
        canvas.text(
            name, origin + 0.31 * along, canvas.palette.steel, fontsize=6, ha="center", va="center"
        )
