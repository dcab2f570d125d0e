"""Writing the report."""

from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined, Template

from rga.diagnosis.findings import Findings
from rga.report.page import page


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
    html = _template().render(page(findings))
    temporary = path.with_name(path.name + ".partial")
    # A name from a JSON file may hold half a surrogate pair, which UTF-8 cannot.
    temporary.write_bytes(html.encode("utf-8", "replace"))
    temporary.replace(path)
    return path


def _template() -> Template:
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    text = files("rga.report").joinpath("report.html.j2").read_text(encoding="utf-8")
    return environment.from_string(text)
