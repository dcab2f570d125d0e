"""A mast, the table of modes that were found of it, and all that can be bad in either."""

import json
from collections.abc import Callable, Sequence
from copy import deepcopy
from functools import cache
from typing import Any

import numpy as np

import rga
from rga.model import read_model
from rga.model.io import model_content

Shape = list[Any]
WINDOWS, SCATTER, SHAPE_NOISE = 20, 0.002, 0.01
#: computed modes of which something moves at the points: the third turns about the axis
CHOSEN = (0, 1, 3, 4)
POINTS = tuple(f"{way}{at}" for way in "XY" for at in (1, 2, 3))


@cache
def _mast() -> tuple[dict[str, Any], list[float], list[list[float]]]:
    build = rga.ModelBuilder("mast").add_material("steel", "S355").add_section("tube", "HEB 200")
    for at in range(4):
        build.add_node(f"n{at}", z=2.0 * at)
        if at:
            build.add_member(f"n{at - 1}", f"n{at}", "tube", kind="frame")
    content = model_content(build.support("n0", "fixed").mass("n3", "400 kg").build())
    content["masses"] = {"head": next(iter(content["masses"].values()))}
    content["points"] = {
        name: {"node": f"n{name[1]}", "direction": [1, 0, 0] if name[0] == "X" else [0, 1, 0]}
        for name in POINTS
    }
    found = rga.modes(read_model(content, "mast"), 5)
    shapes = [
        [float(found.shapes[k, int(name[1]), "XY".index(name[0])]) for name in POINTS]
        for k in CHOSEN
    ]
    frequencies = [float(found.frequencies[k]) for k in CHOSEN]
    content["modes"] = {
        f"m{k}": {"near": f, "within": 0.2, "shape": dict(zip(POINTS, shape, strict=True))}
        for k, (f, shape) in enumerate(zip(frequencies, shapes, strict=True))
    }
    content["context"] = {"air": {"unit": "degC", "range": [-20, 40]}}
    return content, frequencies, shapes


def model(*path: str, value: Any = None) -> bytes:
    """The model file, with another value at a path of keys."""
    content = deepcopy(_mast()[0])
    place: Any = content
    for key in path[:-1]:
        place = place[key]
    if path:
        place[path[-1]] = value
    return json.dumps(content).encode()


def table(
    frequency: Callable[[float], float] = lambda f: f,
    shape: Callable[[Shape], Shape] = lambda s: s,
    columns: Sequence[str] = POINTS,
    header: str = "time,f",
    windows: int = WINDOWS,
    **beside: Callable[[int], Any],
) -> bytes:
    """The long table of modes, with other frequencies or shapes.

    Args:
        frequency, shape: of what was found.
        columns: names of those of the shape.
        header: of the first two columns.
        windows: in which modes were found.
        beside: more columns, by the number of the mode.
    """
    draw = np.random.default_rng(0)
    _, frequencies, shapes = _mast()
    lines = [",".join([header, *columns, *beside])]
    for window in range(windows):
        for mode, (f, own) in enumerate(zip(frequencies, shapes, strict=True)):
            found = f * float(np.exp(SCATTER * draw.standard_normal()))
            size = SHAPE_NOISE * max(map(abs, own))
            cells = shape([x + size * float(draw.standard_normal()) for x in own])
            more = [one(mode) for one in beside.values()]
            cells = [600 * window, frequency(found), *cells, *more]
            lines.append(",".join("" if one is None else str(one) for one in cells))
    return ("\n".join(lines) + "\n").encode()


def first() -> float:
    """The lowest frequency [Hz]."""
    return _mast()[1][0]
