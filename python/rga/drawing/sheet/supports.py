"""Supports as engineers draw them."""

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.scene import Scene
from rga.drawing.scene.supports import SupportMark
from rga.drawing.sheet.canvas import Canvas

#: height and half width of a triangle, half length of the ground [inch]
HIGH, HALF, GROUND = 0.13, 0.085, 0.12
#: share of a direction that must lie in the paper to be seen there
SEEN = 0.3
DOWN = np.array([0.0, -1.0])


def draw_supports(canvas: Canvas, marks: list[SupportMark], scene: Scene) -> None:
    """Supports of a view: a wall, a triangle, a triangle on rollers, or links.

    On an elevation only what is held within the paper counts; in an axonometry a node that is held
    in some directions has a link along each of them.
    """
    shown = set(canvas.view.nodes.tolist())
    for mark in marks:
        if mark.node not in shown:
            continue
        at = canvas.inches(scene.points[mark.node])
        held = [v for v in map(canvas.direction, mark.held) if np.linalg.norm(v) > SEEN]
        if canvas.view.straight:
            _in_paper(canvas, at, held, mark)
        elif mark.sort == "fixed":
            _wall(canvas, at, DOWN)
        elif mark.sort == "pinned":
            _triangle(canvas, at, DOWN)
        else:
            for direction in held:
                _link(canvas, at, direction if direction[1] <= 0 else -direction)


def _in_paper(canvas: Canvas, at: FloatArray, held: list[FloatArray], mark: SupportMark) -> None:
    towards = canvas.view.towards
    clamped = any(abs(float(axis @ towards)) > 0.9 for axis in mark.clamped)
    outward = canvas.direction(mark.outward)
    directions = np.array(held).reshape(-1, 2)
    rank = int(np.linalg.matrix_rank(directions, tol=SEEN)) if len(directions) else 0
    if rank == 2 and clamped:
        _wall(canvas, at, _snapped(outward))
    elif rank == 2:
        _triangle(canvas, at, -DOWN if outward[1] > 0.7 else DOWN)
    elif rank == 1:
        along = directions[0] / np.linalg.norm(directions[0])
        downward = along[1] < -SEEN or (abs(along[1]) <= SEEN and along @ outward > 0)
        along = along if downward else -along
        if clamped:
            _sliding_wall(canvas, at, along)
        else:
            _triangle(canvas, at, along, rollers=True)
    elif clamped:
        half = 0.055
        box = at + half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        canvas.areas([box], canvas.palette.paper, canvas.palette.ink, 0.9, zorder=3)
    else:
        # Held across the paper alone.
        canvas.axes.plot(
            *(at * canvas.unit), "o", markersize=7, mfc="none", mec=canvas.palette.ink, mew=0.8,
            zorder=3,
        )  # fmt: skip


def _snapped(direction: FloatArray) -> FloatArray:
    """The axis of the paper that is nearest to a direction; downward where there is none."""
    if np.linalg.norm(direction) < SEEN or direction[1] < -SEEN:
        return DOWN
    if abs(direction[0]) >= abs(direction[1]):
        return np.array([np.sign(direction[0]), 0.0])
    return -DOWN


def turned(along: FloatArray) -> FloatArray:
    """A direction turned by a right angle, float[2]."""
    return np.array([-along[1], along[0]])


def _triangle(canvas: Canvas, at: FloatArray, along: FloatArray, rollers: bool = False) -> None:
    across = turned(along)
    base = at + HIGH * along
    corners = np.array([at, base + HALF * across, base - HALF * across])
    canvas.areas([corners], canvas.palette.paper, canvas.palette.ink, 0.9, zorder=3)
    if rollers:
        wheels = np.array([base + 0.027 * along + k * 0.05 * across for k in (-1, 1)])
        canvas.axes.plot(
            *(wheels * canvas.unit).T, "o", markersize=2.6, mfc=canvas.palette.paper,
            mec=canvas.palette.ink, mew=0.7, zorder=3,
        )  # fmt: skip
        base = base + 0.054 * along
    draw_ground(canvas, base, along)
    canvas.keep_clear(at + 0.12 * along, 0.13)


def _wall(canvas: Canvas, at: FloatArray, along: FloatArray) -> None:
    across = turned(along)
    base = at + 0.02 * along
    canvas.lines(
        [np.array([base - GROUND * across, base + GROUND * across])], canvas.palette.ink, 2.0,
        zorder=3,
    )  # fmt: skip
    _hatch(canvas, base, along)
    canvas.keep_clear(at + 0.07 * along, 0.13)


def _sliding_wall(canvas: Canvas, at: FloatArray, along: FloatArray) -> None:
    across = turned(along)
    half = 0.8 * GROUND * across
    plate = at + 0.02 * along
    canvas.lines([np.array([plate - half, plate + half])], canvas.palette.ink, 2.0, zorder=3)
    wheels = np.array([at + 0.055 * along + k * 0.06 * across for k in (-1, 1)])
    canvas.axes.plot(
        *(wheels * canvas.unit).T, "o", markersize=2.6, mfc=canvas.palette.paper,
        mec=canvas.palette.ink, mew=0.7, zorder=3,
    )  # fmt: skip
    draw_ground(canvas, at + 0.09 * along, along)


def draw_ground(canvas: Canvas, at: FloatArray, along: FloatArray) -> None:
    """The ground under what stands on it, at a point [inch]."""
    across = turned(along)
    ends = np.array([at - GROUND * across, at + GROUND * across])
    canvas.lines([ends], canvas.palette.ink, 0.9, zorder=3)
    _hatch(canvas, at, along)


def _hatch(canvas: Canvas, at: FloatArray, along: FloatArray) -> None:
    across = turned(along)
    starts = [at + k * GROUND * across for k in (-0.75, -0.25, 0.25, 0.75)]
    ticks = [np.array([one, one + 0.045 * along - 0.04 * across]) for one in starts]
    canvas.lines(ticks, canvas.palette.ink, 0.6, zorder=3)


def _link(canvas: Canvas, at: FloatArray, direction: FloatArray) -> None:
    along = direction / np.linalg.norm(direction)
    end = at + 0.17 * direction
    half = 0.06 * turned(along)
    bar, foot = np.array([at, end]), np.array([end - half, end + half])
    canvas.lines([bar, foot], canvas.palette.ink, 1.2, zorder=3)
    canvas.keep_clear(at + 0.1 * along, 0.05)
