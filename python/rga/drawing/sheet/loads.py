"""Loads on a view: arrows at nodes, along members, and axles on their path."""

from collections.abc import Sequence

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.loads import AlongMember, LoadMark
from rga.drawing.scene.scene import Scene
from rga.drawing.sheet.canvas import Canvas

#: the longest arrow, the longest one of a load along a member, and heads [inch]
LONGEST, ALONG, HEAD = 0.45, 0.26, 0.075
#: from one arrow along a member to the next [inch]
APART = 0.22


def draw_loads(canvas: Canvas, marks: Sequence[LoadMark], scene: Scene) -> None:
    """Each load in its own colour; its largest force is the longest arrow."""
    nodes = set(canvas.view.nodes.tolist())
    places = canvas.inches(scene.points)
    for number, mark in enumerate(marks):
        colour = canvas.palette.loads[number % len(canvas.palette.loads)]
        if mark.path and set(mark.path) <= nodes:
            path = places[list(mark.path)]
            canvas.lines([path], colour, 1.0, zorder=1, linestyles=[(0, (1.5, 2.5))], alpha=0.8)
        sizes = np.linalg.norm(mark.forces, axis=1)
        reach = LONGEST / max(float(sizes.max(initial=0.0)), 1e-300)
        here = [k for k, node in enumerate(mark.nodes.tolist()) if node in nodes]
        heads = canvas.inches(mark.points[here])
        tails = heads - reach * canvas.view.flat(mark.forces[here])
        _arrows(canvas, tails, heads, colour)
        _along(canvas, mark.along, scene, colour)
        for node, moment in zip(mark.turned.tolist(), mark.moments, strict=True):
            if node in nodes:
                _moment(canvas, places[node], moment, colour)


def _arrows(canvas: Canvas, tails: FloatArray, heads: FloatArray, colour: str) -> None:
    along = heads - tails
    lengths = np.linalg.norm(along, axis=1)
    seen = lengths > 0.02
    tails, heads, along, lengths = tails[seen], heads[seen], along[seen], lengths[seen]
    if not len(heads):
        return
    unit = along / lengths[:, None]
    across = np.column_stack([-unit[:, 1], unit[:, 0]])
    back = heads - np.minimum(HEAD, 0.6 * lengths)[:, None] * unit
    canvas.lines(np.stack([tails, back], axis=1), colour, 1.2, zorder=6)
    corners = [heads, back + 0.4 * HEAD * across, back - 0.4 * HEAD * across]
    canvas.areas(list(np.stack(corners, axis=1)), colour, colour, 0.3, zorder=6)
    canvas.avoid(np.stack([tails, heads], axis=1))


def _along(canvas: Canvas, loads: Sequence[AlongMember], scene: Scene, colour: str) -> None:
    shown = set(canvas.view.members.tolist())
    most = max((float(np.linalg.norm(one.forces, axis=1).max()) for one in loads), default=0.0)
    for one in loads:
        if one.member not in shown:
            continue
        ends = canvas.inches(scene.along(one.member, np.array(one.places)))
        length = float(np.linalg.norm(ends[1] - ends[0]))
        shares = np.linspace(0.0, 1.0, max(round(length / APART), 1) + 1)[:, None]
        feet = ends[0] + shares * (ends[1] - ends[0])
        forces = one.forces[0] + shares * (one.forces[1] - one.forces[0])
        tails = feet - ALONG / most * canvas.view.flat(forces)
        outline = np.vstack([feet[:1], tails, feet[-1:]])
        canvas.lines([outline], colour, 0.7, zorder=5, alpha=0.9)
        canvas.areas([outline], colour, "none", 0.0, zorder=1, alpha=0.12)
        _arrows(canvas, tails, feet, colour)


def _moment(canvas: Canvas, centre: FloatArray, moment: FloatArray, colour: str) -> None:
    """An arc about an axis that points out of the paper, else an arrow with two heads."""
    unit = moment / np.linalg.norm(moment)
    turning = float(unit @ canvas.view.towards)
    if abs(turning) > 0.7:
        turn = np.radians(np.linspace(-140, 110, 30)) * np.sign(turning)
        curve = centre + 0.14 * np.column_stack([np.cos(turn), np.sin(turn)])
        canvas.lines([curve[:-3]], colour, 1.2, zorder=6)
        _arrows(canvas, curve[-6:-5], curve[-1:], colour)
        return
    along = canvas.view.flat(unit)
    _arrows(canvas, (centre - LONGEST * along)[None], centre[None], colour)
    _arrows(canvas, (centre - LONGEST * along)[None], (centre - 0.08 * along)[None], colour)
