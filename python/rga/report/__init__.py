"""The report: what a diagnosis found, as one HTML file that opens without a network."""

from rga.report.write import write_report

__all__ = ["write_report"]
