"""Colours of drawings, on white paper and on a dark screen."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Palette:
    """Colours for one background.

    Attributes:
        paper, ink, faint: the background, lines and text, what steps back.
        steel: members of no group.
        groups: of groups of members; beyond these they repeat with broken lines.
        loads: of load effects.
        deformed: of the deformed shape.
        positive, negative: of forces.
        axes: of local x, y and z.
    """

    paper: str
    ink: str
    faint: str
    steel: str
    groups: tuple[str, ...]
    loads: tuple[str, ...]
    deformed: str
    positive: str
    negative: str
    axes: tuple[str, str, str]


# Okabe and Ito's colours, dark or light enough for their background: colour-blind readers tell
# them apart. Reds are kept for loads.
LIGHT = Palette(
    paper="#ffffff",
    ink="#24292f",
    faint="#c4c9ce",
    steel="#6e7781",
    groups=("#0072b2", "#b26a00", "#009e73", "#a8548a", "#2e9bd6", "#7a6f00", "#5a4fcf", "#6b4a2b"),
    loads=("#cf222e", "#e0569b", "#8f2d04", "#d9480f"),
    deformed="#d55e00",
    positive="#0072b2",
    negative="#d55e00",
    axes=("#cf222e", "#1a7f37", "#0550ae"),
)
DARK = Palette(
    paper="#0d1117",
    ink="#e6edf3",
    faint="#3d444d",
    steel="#9198a1",
    groups=("#4cb2f0", "#f0a63c", "#3ad6a8", "#e08fc0", "#9ad4f5", "#e0d64a", "#a99cff", "#c99b6d"),
    loads=("#ff6b6b", "#ff9bd2", "#ffa07a", "#ff8c42"),
    deformed="#ff9f45",
    positive="#58b2f0",
    negative="#ff9f45",
    axes=("#ff7b72", "#56d364", "#79c0ff"),
)
#: lines of groups beyond the colours
DASHES: tuple[tuple[float, ...], ...] = ((), (5.0, 1.6), (1.6, 1.2))


def group_look(palette: Palette, number: int) -> tuple[str, tuple[float, ...]]:
    """Colour and dashes of a group; -1 is a member of none.

    >>> group_look(LIGHT, 0), group_look(LIGHT, 8)
    (('#0072b2', ()), ('#0072b2', (5.0, 1.6)))
    """
    if number < 0:
        return palette.steel, ()
    turn, place = divmod(number, len(palette.groups))
    return palette.groups[place], DASHES[turn % len(DASHES)]
