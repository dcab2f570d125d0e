"""Charts of records and findings, for a notebook."""

from rga.drawing.charts.findings import plot_findings
from rga.drawing.charts.gap import plot_gap
from rga.drawing.charts.pairs import plot_pairs
from rga.drawing.charts.record import plot_record

__all__ = ["plot_findings", "plot_gap", "plot_pairs", "plot_record"]
