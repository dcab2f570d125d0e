"""Reports on paper."""

import shutil
import sys
from pathlib import Path

import pytest

from rga.errors import InputError, MissingPackageError
from rga.report import pdf

PAGE = "<!doctype html><title>A page</title><p>One</p><p style='break-before: page'>Two</p>"


@pytest.fixture
def report(tmp_path: Path) -> Path:
    path = tmp_path / "report.html"
    path.write_text(PAGE, encoding="utf-8")
    return path


def browser(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A browser of our own making on the path of commands."""
    made = folder / "chromium"
    made.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    made.chmod(0o755)
    monkeypatch.setattr(shutil, "which", lambda name: str(made) if name == "chromium" else None)


class TestPdf:
    def test_a_browser_prints_where_there_is_one(
        self, report: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        printed = 'for one in "$@"; do case $one in --print-to-pdf=*) out=${one#*=};; esac; done\n'
        browser(tmp_path, f'{printed}echo "%PDF of $one" > "$out"', monkeypatch)
        pdf.write_pdf(report, tmp_path / "out" / "report.pdf")
        said = (tmp_path / "out" / "report.pdf").read_text(encoding="utf-8")
        assert said == f"%PDF of {report.as_uri()}\n"

    def test_without_browser_and_weasyprint_one_line_says_what_to_install(
        self, report: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        browser(tmp_path, "exit 1", monkeypatch)  # one that fails is none
        monkeypatch.setitem(sys.modules, "weasyprint", None)
        with pytest.raises((MissingPackageError, InputError), match="weasyprint"):
            pdf.write_pdf(report, tmp_path / "report.pdf")
        assert not (tmp_path / "report.pdf").exists()

    def test_weasyprint_prints_where_there_is_no_browser(
        self, report: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        pytest.importorskip("weasyprint")
        monkeypatch.setattr(shutil, "which", lambda name: None)
        pdf.write_pdf(report, tmp_path / "report.pdf")
        content = (tmp_path / "report.pdf").read_bytes()
        assert content.startswith(b"%PDF")
        assert content.rstrip().endswith(b"%%EOF")

    def test_a_report_is_printed_on_a4(self) -> None:
        template = Path(pdf.__file__).parent / "templates" / "style.css.j2"
        assert "@page { size: A4;" in template.read_text(encoding="utf-8")
