"""A report on paper: by a browser where one is installed, otherwise by WeasyPrint."""

import os
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

from rga.errors import InputError
from rga.files import write_whole
from rga.lazy import needing_extras

#: commands of browsers that print without a window
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "microsoft-edge", "msedge")
#: time that a browser may take [s]
PATIENCE = 120


def write_pdf(report: Path, path: Path) -> None:
    """Print an HTML report.

    Args:
        report: the HTML file.
        path: the PDF file; written under a temporary name, then renamed.

    Raises:
        MissingPackageError: there is neither a browser nor WeasyPrint.
        InputError: the place cannot be written to, or WeasyPrint lacks a library of the system.
    """
    with TemporaryDirectory() as folder:
        draft = Path(folder) / "report.pdf"
        if not _printed_by_browser(report, draft, Path(folder)):
            _printed_by_weasyprint(report, draft)
        write_whole({path: draft.read_bytes()})


def _printed_by_weasyprint(report: Path, draft: Path) -> None:
    try:
        with needing_extras():
            from weasyprint import HTML
    except OSError as error:
        lacking = " ".join(str(error).split())
        raise InputError(
            f"WeasyPrint does not start: {lacking}", "--pdf", "install Pango, or a browser"
        ) from None
    HTML(report).write_pdf(draft)


def _printed_by_browser(report: Path, draft: Path, folder: Path) -> bool:
    """Whether a browser that is installed has printed the report."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        return False
    # Its sandbox does not start as root, as in a container.
    unboxed = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
    command = [
        browser, "--headless", "--disable-gpu", "--no-pdf-header-footer", *unboxed,
        f"--user-data-dir={folder / 'profile'}", f"--print-to-pdf={draft}",
        report.absolute().as_uri(),
    ]  # fmt: skip
    try:
        subprocess.run(command, check=True, capture_output=True, timeout=PATIENCE)
    except (OSError, subprocess.SubprocessError):
        return False
    return draft.is_file() and draft.stat().st_size > 0
