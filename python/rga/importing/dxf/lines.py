"""Lines of a drawing, and what else is in it."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from rga.bounded_files import fault_of
from rga.errors import InputError
from rga.importing.draft import FARTHEST
from rga.importing.reading import read_bytes
from rga.lazy import needing_extras

#: bytes of the largest drawing, and lines of the fullest
LARGEST, MOST_LINES = 32 * 2**20, 100_000


@dataclass(frozen=True)
class Line:
    """A straight line, in the units of the drawing."""

    start: tuple[float, float, float]
    end: tuple[float, float, float]
    layer: str
    where: str


@dataclass
class Drawing:
    """A drawing.

    Attributes:
        unit: code of its unit ($INSUNITS); 0: none.
        lines: all straight ones.
        curved: places of arcs in polylines.
        texts: words and place of each.
        others: how many entities of other kinds there are.
    """

    unit: int = 0
    lines: list[Line] = field(default_factory=list)
    curved: list[str] = field(default_factory=list)
    texts: list[tuple[str, str]] = field(default_factory=list)
    others: Counter[str] = field(default_factory=Counter)


def read_drawing(path: Path) -> Drawing:
    """Read a drawing.

    Raises:
        InputError: it is none, damaged, or has more lines than any structure.
    """
    with needing_extras():
        from ezdxf.filemanagement import readfile
    if len(read_bytes(path)) > LARGEST:
        raise InputError(
            f"the drawing has more than {LARGEST // 2**20} MiB",
            str(path),
            "give the structure only",
        )
    try:
        document = readfile(path)
        drawing = Drawing(int(document.header.get("$INSUNITS", 0)))
        for entity in document.modelspace():
            _add(drawing, entity)
    except InputError:
        raise
    except Exception as error:
        what = f"this is no whole drawing: {fault_of(error)[:100]}"
        raise InputError(what, str(path), "save it again as DXF") from None
    return drawing


def _add(drawing: Drawing, entity: Any) -> None:
    kind = entity.dxftype()
    layer = str(entity.dxf.get("layer", "0"))
    where = f"{kind} {entity.dxf.handle}"
    if kind == "LINE":
        _line(drawing, tuple(entity.dxf.start), tuple(entity.dxf.end), layer, where)
    elif kind in ("LWPOLYLINE", "POLYLINE"):
        _polyline(drawing, entity, layer, where)
    elif kind in ("TEXT", "MTEXT", "ATTRIB"):
        words = entity.plain_text() if kind != "ATTRIB" else entity.dxf.text
        x, y, *_ = entity.dxf.insert
        drawing.texts.append((" ".join(str(words).split())[:60], f"{where} at {x:g}, {y:g}"))
    else:
        drawing.others[kind] += 1


def _line(drawing: Drawing, start: Any, end: Any, layer: str, where: str) -> None:
    if len(drawing.lines) >= MOST_LINES:
        raise InputError(f"there are more than {MOST_LINES} lines", where, "give fewer")
    if not all(abs(value) <= FARTHEST for value in (*start, *end)):
        raise InputError("a line ends farther away than any drawing reaches", where, "correct it")
    drawing.lines.append(Line(start, end, layer, where))


def _polyline(drawing: Drawing, entity: Any, layer: str, where: str) -> None:
    if entity.dxftype() == "POLYLINE" and not (entity.is_2d_polyline or entity.is_3d_polyline):
        drawing.others["POLYLINE of a mesh"] += 1
        return
    points = list(_points(entity))
    if entity.is_closed:
        points.append(points[0])
    for (start, bulge), (end, _) in pairwise(points):
        if bulge:
            drawing.curved.append(where)
        else:
            _line(drawing, start, end, layer, where)


def _points(entity: Any) -> Iterator[tuple[tuple[float, float, float], float]]:
    """Points of a polyline, and how much the part behind each is bent."""
    if entity.dxftype() == "LWPOLYLINE":
        height = float(entity.dxf.get("elevation", 0.0))
        for x, y, bulge in entity.get_points("xyb"):
            yield (float(x), float(y), height), float(bulge)
    else:
        for vertex in entity.vertices:
            x, y, z = vertex.dxf.location
            yield (float(x), float(y), float(z)), float(vertex.dxf.get("bulge", 0.0))
