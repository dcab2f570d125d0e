"""Springs, ties and masses on a view."""

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.scene import Scene
from rga.drawing.scene.supports import SpringMark
from rga.drawing.sheet.canvas import Canvas
from rga.drawing.sheet.supports import SEEN, draw_ground, turned

#: distance of nodes from which a spring between them is drawn from one to the other [inch]
APART = 0.26


def draw_springs(canvas: Canvas, marks: list[SpringMark], scene: Scene) -> None:
    """Zigzags along springs; a spiral where a turn is resisted."""
    shown = set(canvas.view.nodes.tolist())
    places = canvas.inches(scene.points)
    for mark in marks:
        if mark.node not in shown:
            continue
        at = places[mark.node]
        if mark.turns:
            _spiral(canvas, at)
        elif mark.to is not None and np.linalg.norm(places[mark.to] - at) > APART:
            canvas.lines([_zigzag(at, places[mark.to])], canvas.palette.ink, 0.9, zorder=5)
        else:
            towards = canvas.direction(mark.direction)
            if np.linalg.norm(towards) < SEEN:
                continue
            towards = towards / np.linalg.norm(towards)
            towards = towards if towards[1] < -1e-9 or towards[0] < 0 else -towards
            end = at + 0.3 * towards
            canvas.lines([_zigzag(at, end)], canvas.palette.ink, 0.9, zorder=5)
            if mark.to is None:
                draw_ground(canvas, end, towards)


def draw_ties(canvas: Canvas, scene: Scene) -> None:
    """A dotted line between nodes that move together."""
    shown = set(canvas.view.nodes.tolist())
    places = canvas.inches(scene.points)
    pairs = [[scene.nodes[node] for node in tie.nodes] for tie in scene.model.ties]
    lines = [places[pair] for pair in pairs if set(pair) <= shown]
    canvas.lines(lines, canvas.palette.ink, 1.0, zorder=5, linestyles=[(0, (1.0, 2.0))])


def draw_masses(canvas: Canvas, scene: Scene) -> None:
    """A filled square at every mass."""
    shown = set(canvas.view.nodes.tolist())
    masses = scene.model.masses.values()
    nodes = {scene.nodes[mass.node] for mass in masses if mass.node is not None} & shown
    if nodes:
        places = canvas.inches(scene.points[sorted(nodes)]) * canvas.unit
        canvas.axes.plot(
            *places.T, "s", markersize=6.5, mfc=canvas.palette.ink, mec=canvas.palette.paper,
            mew=0.6, zorder=5,
        )  # fmt: skip


def _zigzag(first: FloatArray, last: FloatArray) -> FloatArray:
    along = last - first
    across = 0.045 * turned(along / np.linalg.norm(along))
    shares = np.array([0.0, 0.2, 0.27, 0.4, 0.53, 0.66, 0.73, 0.8, 1.0])
    sides = np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
    return np.asarray(first + shares[:, None] * along + sides[:, None] * across)


def _spiral(canvas: Canvas, at: FloatArray) -> None:
    turn = np.linspace(0.0, 4.5 * np.pi, 60)
    reach = 0.03 + 0.09 * turn / turn[-1]
    curve = at + reach[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    canvas.lines([curve], canvas.palette.ink, 0.9, zorder=5)
