"""Drawing a model: into a file, or into axes of matplotlib."""

import textwrap
from pathlib import Path
from typing import Unpack

from matplotlib.axes import Axes

from rga.drawing.content import Content, DrawingOptions, asked, gather
from rga.drawing.figure_style import style
from rga.drawing.label import label
from rga.drawing.sheet import legend
from rga.drawing.sheet.sheet import WIDTH, letters, sheet, sheet_bytes
from rga.drawing.sheet.view import draw_view, palette_of
from rga.drawing.views import views_of
from rga.errors import InputError
from rga.files import as_file, write_whole, wrong_ending
from rga.model import as_model
from rga.model.schema import Model
from rga.simulation import Results

SUFFIXES = (".svg", ".png", ".html")
#: widths of a sheet [inch]
NARROWEST, IN_NOTEBOOK, WIDEST = 3.0, 9.0, 40.0


def draw(
    model: Model | str | Path,
    path: str | Path,
    *,
    width: float = WIDTH,
    **options: Unpack[DrawingOptions],
) -> Path:
    """Write a drawing of a model.

    Args:
        model: the model, or its file.
        path: of a .svg, .png or .html file; the page turns with the mouse. Its folder is made
            where it is missing.
        width: of a sheet [inch]; 3.75 suits a phone.
        options: what is to be seen beside members and supports, by the names of `Selection`.

    Returns:
        The path.

    Raises:
        InputError: another suffix, nothing to draw, an unknown load or context, or a place that
            cannot be written.
        UnstableStructureError: a deformed shape or forces of a structure that can move.
    """
    model, path, shown = as_model(model), as_file(path), asked(options)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise wrong_ending(path, "drawing", SUFFIXES)
    if not NARROWEST <= width <= WIDEST:
        raise InputError(
            f"a sheet cannot be {width:g} inches wide",
            "width",
            f"give {NARROWEST:g} to {WIDEST:g}",
        )
    if suffix == ".html":
        # Templates take time to load, which a sheet does without.
        from rga.drawing.page.page import page

        written = page(model, shown).encode("utf-8", "replace")
    else:
        written = sheet_bytes(gather(model, shown), suffix[1:], width)
    write_whole({path: written})
    return path


def plot_model(
    model: Model | str | Path,
    ax: Axes | None = None,
    *,
    view: str | None = None,
    **options: Unpack[DrawingOptions],
) -> Axes:
    """One view of a model in axes of matplotlib.

    Args:
        model: the model, or its file.
        ax: axes; None: those of a new figure.
        view: title of one of its views, such as "plan"; None: the first.
        options: what is to be seen beside members and supports, by the names of `Selection`.

    Returns:
        The axes, in the metres of the view.

    Raises:
        InputError: as for `draw`; a view that the model does not have.
        UnstableStructureError: as for `draw`.
    """
    return _plot(gather(as_model(model), asked(options)), ax, view)


def plot_results(
    found: Results,
    ax: Axes | None = None,
    *,
    row: int = 1,
    view: str | None = None,
    **options: Unpack[DrawingOptions],
) -> Axes:
    """The deformed shape, or a diagram of forces, of one row of results.

    Args:
        found: the results.
        ax: axes; None: those of a new figure.
        row: of the contexts, from 1.
        view: as for `plot_model`.
        options: as for `plot_model`, but for the contexts; without `forces` the deformed shape.

    Returns:
        The axes, in the metres of the view.

    Raises:
        InputError: as for `plot_model`; a row that there is not.
    """
    rows = len(found.displacements)
    if not 1 <= row <= rows:
        raise InputError(f"there is no row {row}", "results", f"give 1 to {rows}")
    shown = asked({"deformed": options.get("forces") is None, **options})
    return _plot(gather(found.model, shown, found, row - 1), ax, view)


def _plot(content: Content, ax: Axes | None, view: str | None) -> Axes:
    model = content.scene.model
    found = views_of(content.scene)
    chosen = next((one for one in found if view in (None, one.title)), None)
    if chosen is None:
        raise InputError(
            f"there is no view {view!r}",
            f"model {model.name!r}",
            "it has " + ", ".join(repr(one.title) for one in found),
        )
    with style():
        if ax is None:
            # A notebook shows figures of pyplot.
            from matplotlib import pyplot

            return sheet(content, IN_NOTEBOOK, [chosen], pyplot.figure).axes[0]
        palette = palette_of(content)
        draw_view(ax, content, chosen)
        wide = ax.get_window_extent().width / ax.figure.dpi
        title = [model.name, *textwrap.wrap(legend.state_words(content.response), letters(wide))]
        ax.set_title("\n".join(label(line, letters(wide)) for line in title), color=palette.ink)
        entries = legend.entries(content, palette)
        if entries:
            ax.legend(
                handles=entries, loc="upper left", bbox_to_anchor=(0.0, -0.01),
                ncols=legend.columns(entries, wide), labelcolor=palette.ink, fontsize=7.2,
            )  # fmt: skip
    return ax
