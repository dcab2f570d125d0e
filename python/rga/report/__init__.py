"""The report: what a diagnosis found, or what a run of the twin lived through, as one HTML file."""

from rga.report.pages.write import write_report, write_run_report

__all__ = ["write_report", "write_run_report"]
