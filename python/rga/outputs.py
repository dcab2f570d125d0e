"""What rga writes to a directory: findings.json, model.json and report.html.

Every file is written under a temporary name first and then renamed.
"""

from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from rga.errors import ReportError, in_short
from rga.files import CannotWrite, as_path, check_place, write_whole
from rga.findings import Findings
from rga.model.io import model_text

if TYPE_CHECKING:
    from rga.twin.outcome import Outcome


FINDINGS, MODEL, REPORT = "findings.json", "model.json", "report.html"


def check_outputs(directory: Path) -> None:
    """Refuse a directory in which the results of a diagnosis would replace its inputs.

    Raises:
        CannotWrite: they would.
    """
    for name in (FINDINGS, MODEL, REPORT):
        check_place(directory / name)


def write_findings(
    findings: Findings,
    directory: str | Path,
    report: Callable[[Findings, Path], Path] | None = None,
) -> Path:
    """Write findings.json and model.json to a directory, then report.html.

    Args:
        findings: with their arrays.
        directory: is made where it is missing.
        report: writes another report than that of a diagnosis.

    Returns:
        The path of the report.

    Raises:
        InputError: they cannot be written there.
        ReportError: the report could not be drawn. Findings and model are there, and a line that
            says so in the place of the report.
    """
    directory = as_path(directory, "directory")
    write_whole(
        {
            directory / MODEL: model_text(findings.extended).encode(),
            directory / FINDINGS: (findings.to_json() + "\n").encode(),
        }
    )
    shown = directory / REPORT
    try:
        return (report or _write_report)(findings, shown)
    except CannotWrite:
        raise
    except Exception as error:  # of any kind: the findings do not hang on their report
        fault = ReportError(in_short(error), directory)
        # A report that stood here is of other findings.
        said = f"The report could not be drawn: {fault.reason}."
        page = f"<!doctype html><title>No report</title><p>{escape(said)}</p>\n"
        write_whole({shown: page.encode()})
        raise fault from error


def write_run(outcome: "Outcome", directory: Path) -> Path:
    """Write findings.json, model.json and report.html of a run; the path of the report.

    Raises:
        ReportError: the report could not be drawn; findings and model are there.
    """

    def report(findings: Findings, path: Path) -> Path:
        # What draws is loaded when it is needed, and may be what fails.
        from rga.report import write_run_report

        return write_run_report(outcome.history, findings, path)

    return write_findings(outcome.findings, directory, report)


def _write_report(findings: Findings, path: Path) -> Path:
    from rga.report import write_report

    return write_report(findings, path)
