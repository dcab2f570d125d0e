"""Writing the report."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from rga.files import write_whole
from rga.findings import Findings
from rga.report.pages.diagnosis_page import page
from rga.report.pages.fault_tolerant_parts import Lost
from rga.report.pages.modal_page import modal_page

if TYPE_CHECKING:
    from rga.twin.history import History


def write_report(findings: Findings, path: Path) -> Path:
    """Write findings as one self-contained HTML file: to a temporary file, then renamed.

    Args:
        findings: with their account.
        path: the file to write.

    Returns:
        The path.

    Raises:
        ValueError: the findings come from a file and carry no arrays to draw.
    """
    if findings.modes is not None and not findings.has_record:
        return _write("modal.html.j2", modal_page(findings, findings.modes), path)
    return _write("report.html.j2", page(findings), path)


def write_run_report(history: "History", findings: Findings, path: Path) -> Path:
    """Write a run of the twin and its closing diagnosis as one self-contained HTML file.

    Args:
        history: what the run left behind.
        findings: the closing diagnosis, with its account.
        path: the file to write: to a temporary file, then renamed.

    Returns:
        The path.

    Raises:
        ValueError: the findings come from a file and carry no arrays to draw.
    """
    # A diagnosis is reported without the twin, which takes long to import.
    from rga.report.pages.run_page import run_page

    return _write("run.html.j2", run_page(history, findings), path)


def _write(template: str, variables: dict[str, Any], path: Path) -> Path:
    environment = Environment(
        loader=PackageLoader("rga.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.tests["lost"] = lambda part: isinstance(part, Lost)
    html = environment.get_template(template).render(variables)
    # A name from a JSON file may hold half a surrogate pair, which UTF-8 cannot.
    write_whole({path: html.encode("utf-8", "replace")})
    return path
