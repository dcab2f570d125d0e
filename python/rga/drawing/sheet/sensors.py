"""Sensors on a view: a symbol for each kind, with the direction in which it measures."""

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.sensors import SensorMark
from rga.drawing.sheet.canvas import Canvas

#: matplotlib's markers by kind
MARKERS = {"displacement": "o", "rotation": "D", "strain": "s", "force": "h", "reaction": "^"}
#: from a node to the symbol of its sensor, and from a member to that at a fibre [inch]
AWAY, FIBRE = 0.27, 0.075
#: sensors in a row at one place [inch]
STEP = 0.13


def draw_sensors(canvas: Canvas, marks: list[SensorMark]) -> dict[str, FloatArray]:
    """Draw the sensors of a view.

    Returns:
        Where the symbols stand, by name [inch].
    """
    nodes, members = set(canvas.view.nodes.tolist()), set(canvas.view.members.tolist())
    placed: dict[str, FloatArray] = {}
    by_kind: dict[str, list[FloatArray]] = {}
    for mark in marks:
        if mark.node in nodes or mark.member in members:
            at = _at_node(canvas, mark) if mark.member is None else _on_member(canvas, mark)
            placed[mark.name] = at
            by_kind.setdefault(mark.kind, []).append(at)
            canvas.keep_clear(at, 0.05)
    for kind, points in by_kind.items():
        canvas.axes.plot(
            *(np.array(points) * canvas.unit).T, MARKERS[kind], mfc=canvas.palette.paper,
            mec=canvas.palette.ink, mew=0.9, markersize=5.0, ls="", zorder=7,
        )  # fmt: skip
    return placed


def _at_node(canvas: Canvas, mark: SensorMark) -> FloatArray:
    """Behind the node, so that what is measured points towards it, as a dial gauge stands."""
    node = canvas.inches(mark.point)
    along = canvas.direction(mark.direction)
    size = float(np.linalg.norm(along))
    if mark.kind == "rotation" or size < 0.3:
        # A turn is about its axis; a direction across the paper is not seen in it.
        at = node + np.array([0.16 + STEP * mark.place, -0.12])
        canvas.lines([np.array([node, at])], canvas.palette.ink, 0.5, zorder=5)
        if mark.kind == "rotation":
            _arc(canvas, at)
        return np.asarray(at)
    along = along / size
    far = AWAY + (0.1 if mark.kind == "reaction" else 0.0) + STEP * mark.place
    across = np.array([-along[1], along[0]])
    if mark.ahead:
        at, tip = node + far * along, node + (far - 0.06) * along
        canvas.lines([np.array([node, tip])], canvas.palette.ink, 0.8, zorder=6)
    else:
        at, tip = node - far * along, node - 0.05 * along
    head = np.array([tip - 0.06 * along + 0.03 * across, tip, tip - 0.06 * along - 0.03 * across])
    canvas.lines([np.array([at, tip]), head], canvas.palette.ink, 0.8, zorder=6)
    return np.asarray(at)


def _on_member(canvas: Canvas, mark: SensorMark) -> FloatArray:
    along = canvas.direction(mark.direction)
    at = canvas.inches(mark.point) + FIBRE * canvas.direction(mark.side)
    size = float(np.linalg.norm(along))
    if size < 0.1:
        return np.asarray(at + np.array([STEP * mark.place, 0.0]))
    along = along / size
    at = at + STEP * mark.place * along
    canvas.lines(
        [np.array([at - 0.1 * along, at + 0.1 * along])], canvas.palette.ink, 0.9, zorder=6
    )
    return np.asarray(at)


def _arc(canvas: Canvas, at: FloatArray) -> None:
    turn = np.linspace(np.radians(-50), np.radians(130), 20)
    curve = at + 0.085 * np.column_stack([np.cos(turn), np.sin(turn)])
    head = curve[-1] + np.array([[0.045, 0.02], [0.0, 0.0], [0.035, -0.035]])
    canvas.lines([curve, head], canvas.palette.ink, 0.7, zorder=6)
