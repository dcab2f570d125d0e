"""The report: what a diagnosis found, or what a run of the twin lived through, as one HTML file."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga.report.pages.write import write_report, write_run_report

__all__ = [
    "write_report",
    "write_run_report",
]

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "write_report": "rga.report.pages.write",
    "write_run_report": "rga.report.pages.write",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
