"""What a run of the twin on a record ended with."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rga.arrays import FloatArray
from rga.findings import Findings
from rga.notebook import short_html
from rga.twin.history import History

if TYPE_CHECKING:
    import polars as pl
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Outcome:
    """What a run ended with.

    Attributes:
        findings: of the closing diagnosis of the whole record.
        history: of the twin.
    """

    findings: Findings
    history: History

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """The gap of every row, and when the twin alarmed and changed, in axes of matplotlib.

        Args:
            ax: axes; None: those of a new figure.
        """
        # matplotlib takes long to load, and a run ends without it.
        from rga.drawing.charts import plot_gap

        rows: dict[str, list[int]] = {}
        for event in self.history.events:
            rows.setdefault(event.kind, []).append(min(event.row, len(self.history.record) - 1))
        return plot_gap(self.history.record, self._gap(), rows, ax)

    def to_frame(self) -> "pl.DataFrame":
        """Time, the gap of each row [-], and the contexts that were inferred, one row a reading.

        The gap is the mean squared difference of measured and simulated over noise variance.
        """
        import polars as pl

        history = self.history
        time = history.record.to_frame()["time"]
        inferred = [
            pl.Series(name, history.inferred[:, k]) for k, name in enumerate(history.contexts)
        ]
        return pl.DataFrame([time, pl.Series("gap", self._gap()), *inferred])

    def _gap(self) -> FloatArray:
        """Of every row, float[rows] [-]; NaN where nothing was simulated."""
        with np.errstate(divide="ignore", invalid="ignore"):
            each = self.history.gaps / self.history.noise**2
        known = np.isfinite(each)
        total = np.where(known, each, 0.0).sum(axis=1)
        return np.asarray(
            np.where(known.any(axis=1), total / np.maximum(known.sum(axis=1), 1), np.nan)
        )

    def _repr_html_(self) -> str:
        history = self.history
        said = (
            f"{self.findings.sentence()} {len(history.record)} rows, "
            f"{len(history.versions)} versions of the model."
        )
        return short_html("run of the twin", said, self.to_frame())
