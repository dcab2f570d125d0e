"""What the script of the page draws, as JSON."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rga.drawing.content import Content
from rga.drawing.palette import DARK, DASHES, LIGHT, Palette
from rga.drawing.scene.loads import LoadMark
from rga.drawing.scene.scene import Scene
from rga.drawing.sheet.legend import load_words, state_words
from rga.drawing.states.deformed import Deformed
from rga.drawing.states.diagrams import SIGNS, Diagram
from rga.drawing.states.response import DrawnResponse
from rga.quantities import quantity, scale

#: digits of places and directions, far below what a screen shows
DIGITS = 6


def page_data(content: Content, response: DrawnResponse | None) -> dict[str, Any]:
    """A model as the page takes it.

    Args:
        content: the model with its loads and sensors.
        response: with its deformed shape and forces; None where the structure can move.
    """
    scene = content.scene
    normal = scene.normal
    return {
        "palettes": {"light": _palette(LIGHT), "dark": _palette(DARK)},
        "dashes": [[2.5 * length for length in dash] for dash in DASHES],
        "normal": None if normal is None else _numbers(normal),
        "points": _numbers(scene.points),
        "nodes": list(scene.nodes),
        "members": {
            "names": list(scene.members),
            "ends": scene.ends.tolist(),
            "group": scene.group.tolist(),
            "frame": scene.frame.tolist(),
            "axes": _numbers(scene.axes),
            "words": _member_words(scene),
        },
        "groups": list(scene.groups),
        "supports": [
            {
                "name": mark.name,
                "node": mark.node,
                "sort": mark.sort,
                "held": _numbers(mark.held),
                "words": _held_words(mark.held, mark.clamped),
            }
            for mark in content.supports
        ],
        "springs": [
            {"node": one.node, "to": one.to, "direction": _numbers(one.direction),
             "turns": one.turns}
            for one in content.springs
        ],
        "ties": [[scene.nodes[node] for node in tie.nodes] for tie in scene.model.ties],
        "masses": [
            {"node": scene.nodes[one.node], "words": f"mass {name}\n{one.mass:g} kg"}
            for name, one in scene.model.masses.items()
            if one.node is not None
        ],
        "sensors": [
            {
                "name": mark.name,
                "kind": mark.kind,
                "words": f"{mark.kind} [{mark.unit}]",
                "at": _numbers(mark.point),
                "direction": _numbers(mark.direction),
                "side": _numbers(mark.side),
                "on": "node" if mark.member is None else "member",
                "place": mark.place,
                "ahead": mark.ahead,
            }
            for mark in content.sensors
        ],
        "loads": [_load(scene, mark) for mark in content.loads],
        "response": None if response is None else _response(scene, response),
    }  # fmt: skip


def _palette(palette: Palette) -> dict[str, Any]:
    return {name: getattr(palette, name) for name in Palette.__dataclass_fields__}


def _numbers(values: ArrayLike) -> Any:
    """Numbers in few digits: a page of thousands of members stays small."""
    array = np.asarray(values, dtype=float)
    short = [float(f"{value:.{DIGITS}g}") for value in array.ravel().tolist()]
    return np.array(short, dtype=float).reshape(array.shape).tolist()


def _member_words(scene: Scene) -> list[str]:
    lengths = np.linalg.norm(np.diff(scene.points[scene.ends], axis=1)[:, 0], axis=1)
    return [
        f"{member.kind}, {quantity(float(length), 'm')}, section {member.section}, "
        f"material {member.material}" + ("; " if member.groups else "") + ", ".join(member.groups)
        for member, length in zip(scene.model.members.values(), lengths, strict=True)
    ]


def _held_words(held: np.ndarray[Any, Any], clamped: np.ndarray[Any, Any]) -> str:
    names = ["xyz"[int(np.argmax(axis))] for axis in held if np.max(np.abs(axis)) > 1 - 1e-9]
    inclined = len(held) - len(names)
    said = [f"held along {', '.join(names)}"] if names else []
    said += ["held along an inclined direction"] if inclined else []
    if len(clamped):
        said.append("clamped about " + ", ".join("xyz"[int(np.argmax(one))] for one in clamped))
    return "; ".join(said) or "held across the plane alone"


def _load(scene: Scene, mark: LoadMark) -> dict[str, Any]:
    largest = float(np.linalg.norm(mark.forces, axis=1).max(initial=0.0)) or 1.0
    spread = [float(np.linalg.norm(one.forces, axis=1).max()) for one in mark.along]
    densest = max(spread, default=1.0) or 1.0
    turning = float(np.linalg.norm(mark.moments, axis=1).max(initial=0.0)) or 1.0
    return {
        "name": mark.name,
        "words": load_words(mark),
        "points": _numbers(mark.points),
        "forces": _numbers(mark.forces / largest),
        "turned": _numbers(scene.points[mark.turned]),
        "moments": _numbers(mark.moments / turning),
        "along": [
            {
                "ends": _numbers(scene.along(one.member, np.array(one.places))),
                "forces": _numbers(one.forces / densest),
            }
            for one in mark.along
        ],
        "path": list(mark.path),
    }


def _response(scene: Scene, response: DrawnResponse) -> dict[str, Any]:
    assert response.deformed is not None
    # Each part in words of its own, and once at which contexts all of them are.
    shape = replace(response, diagrams=(), contexts="")
    forces = replace(response, deformed=None, contexts="")
    return {
        "at": response.contexts,
        "words": state_words(shape),
        "deformed": _deformed(scene, response.deformed),
        "diagrams": [
            {
                **_diagram(scene, diagram),
                "words": state_words(replace(forces, diagrams=(diagram,))),
            }
            for diagram in response.diagrams
        ],
    }


def _deformed(scene: Scene, shape: Deformed) -> dict[str, Any]:
    # A bar stays straight: its ends say all.
    curves = [
        _numbers(curve if bends else curve[[0, -1]])
        for curve, bends in zip(shape.curves, scene.frame, strict=True)
    ]
    return {"scale": shape.scale, "curves": curves}


def _diagram(scene: Scene, diagram: Diagram) -> dict[str, Any]:
    factor, unit = scale(diagram.unit, diagram.largest)
    # Of a bar in which nothing changes along its axis two places say all.
    even = (scene.frame == 0) & (np.ptp(diagram.values, axis=1) <= 1e-9 * diagram.largest)
    stations = [slice(None) if not one else [0, -1] for one in even.tolist()]
    told = [[1] if one else diagram.told(k) for k, one in enumerate(even.tolist())]
    return {
        "quantity": diagram.quantity,
        "unit": unit,
        "factor": factor,
        "signs": SIGNS.get(diagram.quantity, ("positive", "negative")),
        "largest": diagram.largest,
        "told": told,
        "positions": [_numbers(row[k]) for row, k in zip(diagram.positions, stations, strict=True)],
        "values": [_numbers(row[k]) for row, k in zip(diagram.values, stations, strict=True)],
        "sides": _numbers(diagram.sides),
    }
