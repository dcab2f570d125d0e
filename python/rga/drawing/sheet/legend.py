"""What symbols and colours of a drawing mean."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rga.drawing.content import Content
from rga.drawing.label import label
from rga.drawing.labels import LETTER
from rga.drawing.palette import Palette, group_look
from rga.drawing.scene.loads import LoadMark
from rga.drawing.sheet.sensors import MARKERS
from rga.drawing.states.diagrams import SIGNS, WORDS
from rga.drawing.states.response import DrawnResponse
from rga.quantities import quantity, scale

#: groups and loads that are named
MOST_GROUPS, MOST_LOADS = 15, 8
LONGEST = 44
#: inches: a line of the legend, and what stands before a text
LINE, BEFORE = 0.17, 0.5


def entries(content: Content, palette: Palette) -> list[Line2D | Patch]:
    """Groups, sensors by kind, loads, and what is drawn of the response."""
    found: list[Line2D | Patch] = []
    scene = content.scene
    response = content.response
    if response is None:
        for number, name in enumerate(scene.groups[:MOST_GROUPS]):
            colour, dashes = group_look(palette, number)
            line = Line2D([], [], color=colour, lw=2.2, label=label(name, LONGEST))
            line.set_linestyle((0, dashes) if dashes else "solid")
            found.append(line)
        if (left := len(scene.groups) - MOST_GROUPS) > 0:
            found.append(Line2D([], [], lw=0, label=f"and {left} more groups"))
        if scene.groups and (scene.group < 0).any():
            found.append(Line2D([], [], color=palette.steel, lw=2.2, label="in no group"))
    elif response.deformed is not None:
        found.append(Line2D([], [], color=palette.deformed, lw=2.2, label="deformed"))
    for diagram in response.diagrams if response is not None else ():
        if diagram.largest == 0:
            continue
        signs = SIGNS.get(diagram.quantity, ("positive", "negative"))
        for colour, word in zip((palette.positive, palette.negative), signs, strict=True):
            found.append(Patch(fc=colour, ec=colour, alpha=0.45, label=word))
    kinds = {mark.kind for mark in content.sensors}
    found += [
        Line2D(
            [], [], ls="", marker=marker, mfc=palette.paper, mec=palette.ink, mew=0.9,
            markersize=5.0, label=f"{kind} sensor",
        )
        for kind, marker in MARKERS.items()
        if kind in kinds
    ]  # fmt: skip
    if scene.model.masses:
        found.append(Line2D([], [], ls="", marker="s", color=palette.ink, label="mass"))
    for number, mark in enumerate(content.loads[:MOST_LOADS]):
        colour = palette.loads[number % len(palette.loads)]
        found.append(
            Line2D([], [], color=colour, marker=">", markersize=4, lw=1.2, label=load_words(mark))
        )
    if (left := len(content.loads) - MOST_LOADS) > 0:
        found.append(Line2D([], [], lw=0, label=f"and {left} more loads"))
    return found


def load_words(mark: LoadMark) -> str:
    """A load with its largest force, and the contexts that it follows."""
    size, unit = mark.largest
    said = f"{label(mark.name, 24)}: up to {quantity(size, unit)}"
    return f"{said} at {label(mark.at, 40)}" if mark.at else said


def columns(found: list[Line2D | Patch], wide: float) -> int:
    """How many columns of a legend fit into a width [inch]."""
    longest = max(len(str(one.get_label())) for one in found)
    return max(1, min(int(wide / (BEFORE + LETTER * 1.15 * longest)), len(found), 5))


def state_words(response: DrawnResponse | None) -> str:
    """Displacements and forces in a sentence; empty where neither is drawn."""
    if response is None:
        return ""
    said = []
    if (shape := response.deformed) is not None:
        times = f"displacements {shape.scale:g} times as large"
        most = f"largest {quantity(shape.largest, 'm')} at {label(shape.at)}"
        said.append(f"{times}, {most}" if shape.largest > 0 else "nothing moves")
    for diagram in response.diagrams:
        if diagram.largest == 0:
            why = "" if diagram.bends or diagram.quantity == "N" else ": truss members"
            said.append(f"{WORDS[diagram.quantity]}: all zero{why}")
            continue
        _, written = scale(diagram.unit, diagram.largest)
        most = quantity(diagram.largest, diagram.unit)
        said.append(f"{WORDS[diagram.quantity]}, written in {written}, at most {most}")
    words = "; ".join(said)
    return f"{words}; at {response.contexts}" if response.contexts else words
