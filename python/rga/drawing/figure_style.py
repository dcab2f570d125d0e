"""Figures as inline SVG: one look for all, and the same bytes for the same data."""

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from typing import Any

import matplotlib
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

# Okabe and Ito's colours: distinguished by colour-blind readers and in grey print.
MEASURED, BEFORE, AFTER = "#1f2328", "#d55e00", "#0072b2"
STEEL, INK, FAINT, MARKED = "#8b949e", "#24292f", "#d0d7de", "#f0c808"

#: text is laid out with the font that comes with matplotlib, and shown with the reader's own
FONTS = "system-ui, -apple-system, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif"
STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "rga",
    "text.parse_math": False,
    "font.family": ["DejaVu Sans"],
    "font.size": 8.0,
    "text.color": INK,
    "axes.edgecolor": "#57606a",
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 8.5,
    "axes.titlelocation": "left",
    "axes.unicode_minus": True,
    "axes.formatter.use_mathtext": False,
    "xtick.color": "#57606a",
    "ytick.color": "#57606a",
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "lines.solid_capstyle": "round",
}


@contextmanager
def style() -> Iterator[None]:
    """The look of all figures, while one is made and written."""
    with matplotlib.rc_context(STYLE), warnings.catch_warnings():
        # Names may be in scripts that this font lacks; the reader's browser has others.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield


def inline(figure: Figure, name: str, words: str) -> Markup:
    """A figure as an SVG element for a page.

    Args:
        figure: the figure.
        name: unique on the page; keeps the ids of figures apart.
        words: what the figure shows, for readers who do not see it.
    """
    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": f"rga-{name}"}):
        figure.set_canvas(FigureCanvasSVG(figure))
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        figure.savefig(buffer, format="svg", metadata=nothing)
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.DOTALL)
    # Groups are numbered alike in every figure; nothing refers to them.
    text = re.sub(r'<g id="[\w.]+">', "<g>", text)
    text = re.sub(r"'DejaVu Sans'(, ?[^;\"]*)?", FONTS, text)
    # Text from files is escaped already: by the SVG writer, and here.
    opening = f'<svg role="img" aria-label="{escape(words)}"'
    return Markup(text.replace("<svg", opening, 1))


def grid(axes: Axes, axis: str = "both") -> None:
    """A faint grid behind the data."""
    axes.grid(True, axis=axis, color=FAINT, linewidth=0.5)  # type: ignore[arg-type]
    axes.set_axisbelow(True)
