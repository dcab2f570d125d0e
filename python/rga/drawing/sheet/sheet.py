"""A whole drawing: title, views, what the symbols mean."""

import io
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from rga.drawing.content import Content
from rga.drawing.figure_style import inline, style
from rga.drawing.label import label
from rga.drawing.labels import LETTER
from rga.drawing.sheet import legend
from rga.drawing.sheet.canvas import FOOT
from rga.drawing.sheet.view import draw_view, margin_of, palette_of, seen
from rga.drawing.views import View, views_of

#: inches
WIDTH, TITLE, SUBTITLE, PANEL_TITLE, GAP = 10.0, 0.42, 0.16, 0.22, 0.12
#: heights of the first view and of the others, over the width of the sheet
TALLEST, TALLEST_OTHERS = 0.75, 0.42
#: width of a sheet below which views stand one under the other, and of the smallest view [inch]
NARROW, LEAST = 6.5, 2.4
DPI = 150


@dataclass(frozen=True)
class Panel:
    """A view on the sheet: left, top, width and height [inch] from the upper left corner."""

    view: View
    left: float
    top: float
    wide: float
    high: float


def sheet(
    content: Content,
    width: float = WIDTH,
    shown: Sequence[View] | None = None,
    figure: Callable[..., Figure] = Figure,
) -> Figure:
    """The drawing as a figure of matplotlib.

    Args:
        content: what is shown.
        width: of the sheet [inch]; 3.75 suits a phone.
        shown: the views; None: all of the structure.
        figure: makes the figure.
    """
    palette = palette_of(content)
    found = legend.entries(content, palette)
    words = textwrap.wrap(legend.state_words(content.response), letters(width - 0.4))
    head = TITLE + SUBTITLE * len(words)
    panels, bottom = _panels(content, shown or views_of(content.scene), width, head)
    columns = legend.columns(found, width - 0.3) if found else 1
    rows = -(-len(found) // columns)
    high = bottom + 0.1 + legend.LINE * rows + 0.1
    drawn = figure(figsize=(width, high), facecolor=palette.paper, dpi=100)
    name = label(content.scene.model.name, letters((width - 0.4) / 1.7))
    drawn.text(
        0.2 / width, 1 - 0.1 / high, name, fontsize=11, weight="bold", va="top", color=palette.ink
    )
    for number, line in enumerate(words):
        y = 1 - (TITLE - 0.08 + SUBTITLE * number) / high
        drawn.text(0.2 / width, y, line, fontsize=7.5, va="top", color=palette.steel)
    for panel in panels:
        if len(panels) > 1:
            drawn.text(
                panel.left / width, 1 - panel.top / high, panel.view.title, fontsize=8,
                va="top", color=palette.steel,
            )  # fmt: skip
        axes = drawn.add_axes(
            (
                panel.left / width, 1 - (panel.top + PANEL_TITLE + panel.high) / high,
                panel.wide / width, panel.high / high,
            )
        )  # fmt: skip
        missed = draw_view(axes, content, panel.view)
        if any(missed.values()):
            lost = " and ".join(
                f"{n} {what}{'s' if n > 1 else ''}" for what, n in missed.items() if n
            )
            drawn.text(
                (panel.left + panel.wide - 0.15) / width, 1 - panel.top / high,
                f"{lost} without room", fontsize=7,
                ha="right", va="top", color=palette.steel,
            )  # fmt: skip
    if found:
        drawn.legend(
            handles=found, loc="lower left", ncols=columns, labelcolor=palette.ink,
            bbox_to_anchor=(0.1 / width, 0.02 / high), borderaxespad=0.2, fontsize=7.2,
            labelspacing=0.28, handlelength=1.6,
        )  # fmt: skip
    return drawn


def letters(wide: float) -> int:
    """How many letters of a text fit into a width [inch]."""
    return max(int(wide / LETTER), 8)


def _panels(
    content: Content, shown: Sequence[View], width: float, top: float
) -> tuple[list[Panel], float]:
    """The views in rows, as many in each as fit; and where they end."""
    whole = width - 0.3
    others = whole / 2 if width > NARROW else whole
    limits = [(whole, TALLEST * width)] + [(others, TALLEST_OTHERS * width)] * (len(shown) - 1)
    sizes = [_size(content, one, *limit) for one, limit in zip(shown, limits, strict=True)]
    rows: list[list[int]] = []
    for k, (wide, _) in enumerate(sizes):
        row_wide = sum(sizes[j][0] for j in rows[-1]) if rows else whole
        if row_wide + wide <= whole + 1e-9:
            rows[-1].append(k)
        else:
            rows.append([k])
    panels = []
    for row in rows:
        more = (whole - sum(sizes[k][0] for k in row)) / len(row)
        left = 0.15
        for k in row:
            panels.append(Panel(shown[k], left, top, sizes[k][0] + more, sizes[k][1]))
            left += sizes[k][0] + more
        top += PANEL_TITLE + max(sizes[k][1] for k in row) + GAP
    return panels, top


def _size(content: Content, view: View, widest: float, tallest: float) -> tuple[float, float]:
    """Width and height of a view with its symbols [inch], at the largest scale that fits."""
    margin = margin_of(content)
    size = np.ptp(view.flat(seen(content, view)), axis=0)
    room = widest - 2 * margin, tallest - 2 * margin - FOOT
    unit = max(size[0] / room[0], size[1] / room[1], 1e-9)
    wide, high = size / unit + 2 * margin
    return max(float(wide), min(LEAST, widest)), float(high) + FOOT


def sheet_bytes(content: Content, kind: str, width: float = WIDTH) -> bytes:
    """The drawing as the content of a file.

    Args:
        kind: "svg" or "png".
    """
    with style():
        figure = sheet(content, width)
        buffer = io.BytesIO()
        if kind == "png":
            figure.savefig(buffer, format="png", dpi=DPI, facecolor=figure.get_facecolor())
            return buffer.getvalue()
        name = label(content.scene.model.name, 60)
        return str(inline(figure, "drawing", f"Drawing of {name}")).encode("utf-8", "replace")
