"""Axes to draw a chart into."""

from matplotlib.axes import Axes


def axes_or_new(ax: Axes | None, high: float, wide: float = 9.0) -> Axes:
    """The axes given, or those of a new figure of pyplot, which a notebook shows.

    Args:
        ax: axes, or None.
        high, wide: size of a new figure [inch].
    """
    if ax is not None:
        return ax
    from matplotlib import pyplot

    _, made = pyplot.subplots(figsize=(wide, high), layout="constrained")
    return made
