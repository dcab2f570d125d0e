"""Drawing a model: into a file, or into axes of matplotlib."""

from pathlib import Path
from typing import Unpack

from matplotlib.axes import Axes

from rga.drawing.content import Options, asked, gather
from rga.drawing.figure_style import style
from rga.drawing.sheet import legend
from rga.drawing.sheet.sheet import WIDTH, sheet_bytes
from rga.drawing.sheet.view import draw_view, palette_of
from rga.drawing.sight import sights
from rga.errors import InputError
from rga.files import write_whole
from rga.model.schema import Model

SUFFIXES = (".svg", ".png", ".html")
#: widths of a sheet [inch]
NARROWEST, WIDEST = 3.0, 40.0


def draw(
    model: Model, path: str | Path, *, width: float = WIDTH, **options: Unpack[Options]
) -> Path:
    """Write a drawing of a model.

    Args:
        model: the model.
        path: of a .svg, .png or .html file; the page turns with the mouse.
        width: of a sheet [inch]; 3.75 suits a phone.
        options: what is to be seen beside members and supports, by the names of `Shown`.

    Returns:
        The path.

    Raises:
        InputError: another suffix, nothing to draw, an unknown load or context, or a place that
            cannot be written.
        UnstableStructureError: a deformed shape or forces of a structure that can move.
    """
    path, shown = Path(path), asked(options)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        formats = "name a " + ", ".join(SUFFIXES[:-1]) + f" or {SUFFIXES[-1]} file"
        raise InputError(f"{suffix!r} is no format of a drawing", str(path), formats)
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
    model: Model, ax: Axes | None = None, *, view: str | None = None, **options: Unpack[Options]
) -> Axes:
    """One view of a model in axes of matplotlib.

    Args:
        model: the model.
        ax: axes; None: those of a new figure.
        view: title of one of its views, such as "plan"; None: the first.
        options: what is to be seen beside members and supports, by the names of `Shown`.

    Returns:
        The axes, in the metres of the view.

    Raises:
        InputError: as for `draw`; a view that the model does not have.
        UnstableStructureError: as for `draw`.
    """
    content = gather(model, asked(options))
    found = sights(content.scene)
    chosen = next((one for one in found if view in (None, one.title)), None)
    if chosen is None:
        raise InputError(
            f"there is no view {view!r}",
            f"model {model.name!r}",
            "it has " + ", ".join(repr(one.title) for one in found),
        )
    palette = palette_of(content)
    with style():
        if ax is None:
            # A notebook shows figures of pyplot.
            from matplotlib import pyplot

            _, ax = pyplot.subplots(figsize=(9.0, 6.0), layout=None, facecolor=palette.paper)
            ax.set_position((0.02, 0.16, 0.96, 0.76))
        draw_view(ax, content, chosen)
        title = [model.name, legend.state_words(content)]
        ax.set_title("\n".join(line for line in title if line), color=palette.ink, loc="left")
        entries = legend.entries(content, palette)
        if entries:
            wide = ax.get_window_extent().width / ax.figure.dpi
            ax.legend(
                handles=entries, loc="upper left", bbox_to_anchor=(0.0, -0.01),
                ncols=legend.columns(entries, wide), labelcolor=palette.ink, fontsize=7.2,
            )  # fmt: skip
    return ax
