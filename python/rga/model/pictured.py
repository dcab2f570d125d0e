"""A model as a picture and as a table."""

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from rga.notebook import short_html

if TYPE_CHECKING:
    import polars as pl
    from matplotlib.axes import Axes

    from rga.model.schema import Model


class Pictured:
    """What a notebook shows of a model."""

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

    def to_frame(self) -> "pl.DataFrame":
        """The members, one a row: nodes, length [m], section with its area A [m2], E [Pa]."""
        import polars as pl

        model = cast("Model", self)
        members = model.members.values()
        ends = [[model.nodes[node] for node in one.nodes] for one in members]
        spans = np.diff(np.array(ends, dtype=float).reshape(-1, 2, 3), axis=1)[:, 0]
        return pl.DataFrame(
            {
                "member": pl.Series(list(model.members), dtype=pl.String),
                "kind": pl.Series([one.kind for one in members], dtype=pl.String),
                "from": pl.Series([one.nodes[0] for one in members], dtype=pl.String),
                "to": pl.Series([one.nodes[1] for one in members], dtype=pl.String),
                "length": np.linalg.norm(spans, axis=1),
                "section": pl.Series([one.section for one in members], dtype=pl.String),
                "A": [model.sections[one.section].A for one in members],
                "material": pl.Series([one.material for one in members], dtype=pl.String),
                "E": [model.materials[one.material].E for one in members],
                "groups": pl.Series([", ".join(one.groups) for one in members], dtype=pl.String),
            }
        )

    def _repr_html_(self) -> str:
        model = cast("Model", self)
        parts = ("nodes", "members", "supports", "effects", "sensors")
        said = ", ".join(f"{len(getattr(model, part))} {part}" for part in parts)
        return short_html(model.name, said, self.to_frame())
