"""The site of the pages is built without a warning, and needs no network."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import rga
from documentation import ROOT

RESOURCE = re.compile(r"""<(?:script|img|iframe|link)\b[^>]*?(?:src|href)=["'](?:https?:|//)""")
SHEET = re.compile(r"""(?:@import|url\()\s*["']?(?:https?:|//)""")
IMAGE = re.compile(r"""<img\b[^>]*? src="([^"]+)\"""")


def fetched(site: Path) -> list[str]:
    """Files of a site that name a script, an image, a style or a font on the network."""
    pages = [one.name for one in site.rglob("*.html") if RESOURCE.search(one.read_text("utf-8"))]
    return pages + [one.name for one in site.rglob("*.css") if SHEET.search(one.read_text("utf-8"))]


def missing(site: Path) -> list[str]:
    """Images that pages of a site show and that are not there."""
    return [
        f"{page.name}: {image}"
        for page in site.rglob("*.html")
        for image in IMAGE.findall(page.read_text("utf-8"))
        if not (page.parent / image).is_file()
    ]


# One test, so that the site is built once.
def test_the_site_has_every_name_of_rga_and_fetches_nothing(tmp_path: Path) -> None:
    pytest.importorskip("furo", reason="the site is built where rga[docs] is installed")
    build = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "--quiet", "-b", "html"]
    ran = subprocess.run([*build, ROOT / "docs", tmp_path], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr[-4000:]
    pages = [page.read_text("utf-8") for page in (tmp_path / "reference" / "api").glob("*.html")]
    entries = {entry for page in pages for entry in re.findall(r'id="rga\.(\w+)"', page)}
    assert set(rga.__all__) - entries == {"__version__"}
    assert len(list(tmp_path.rglob("*.html"))) > 40
    assert fetched(tmp_path) == []
    assert missing(tmp_path) == []


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("a.html", '<script async src="https://cdn.example/x.js"></script>', True),
        ("a.html", '<link rel="stylesheet" href="//fonts.example/x.css" />', True),
        ("a.css", "@import url(https://fonts.example/x.css);", True),
        ("a.html", '<a href="https://example.org">away</a> <script src="x.js"></script>', False),
    ],
)
def test_what_is_fetched_is_seen(tmp_path: Path, name: str, content: str, found: bool) -> None:
    (tmp_path / name).write_text(content, encoding="utf-8")
    assert fetched(tmp_path) == ([name] if found else [])


def test_an_image_that_is_not_there_is_seen(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text('<img alt="x" src="x.png" />', encoding="utf-8")
    assert missing(tmp_path) == ["a.html: x.png"]
