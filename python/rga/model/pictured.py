"""What a notebook shows of a model."""

from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rga.model.schema import Model


class Pictured:
    """A model as a picture."""

    def plot(self, ax: "Axes | None" = None, **shown: Any) -> "Axes":
        """A view of the model in axes of matplotlib.

        Args:
            ax: axes; None: those of a new figure.
            shown: what is to be seen, as for `rga.plot_model`.

        Raises:
            InputError, UnstableStructureError: as for `rga.plot_model`.
        """
        # What draws stands above the model: it is reached through the front of the package.
        import rga

        return rga.plot_model(cast("Model", self), ax, **shown)
