"""Links between pages lead somewhere, on a forge as in the site."""

import re
from pathlib import Path

import pytest

from documentation import BLOCK, PAGES, ROOT

LINK = re.compile(r"\]\((?!https?://|mailto:)(?P<file>[^)#\s]*)(?:#(?P<anchor>[^)\s]+))?\)")
EVERY = [*PAGES, ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"]


def anchors(page: Path) -> set[str]:
    """What the headings of a page are called in links, as forges do it."""
    headings = re.findall(r"^#+ (.+)$", BLOCK.sub("", page.read_text("utf-8")), re.MULTILINE)
    plain = (re.sub(r"[^\w\- ]", "", one.lower()) for one in headings)
    return {one.strip().replace(" ", "-") for one in plain}


def dead_links(page: Path) -> list[str]:
    """Links of a page to files, or headings in them, that do not exist."""
    dead = []
    for link in LINK.finditer(BLOCK.sub("", page.read_text("utf-8"))):
        target = page.parent / link["file"] if link["file"] else page
        if not target.exists() or (link["anchor"] and link["anchor"] not in anchors(target)):
            dead.append(link[0])
    return dead


@pytest.mark.parametrize("page", EVERY, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_leads_somewhere(page: Path) -> None:
    assert dead_links(page) == []


def test_every_page_is_reached_from_the_front_page() -> None:
    listed = (ROOT / "docs" / "index.md").read_text("utf-8")
    pages = [page.relative_to(ROOT / "docs").with_suffix("") for page in PAGES[1:]]
    assert [str(page) for page in pages if str(page) not in listed and page.name != "index"] == []


def test_a_dead_link_is_seen(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# A `word`, two\n[a](other.md) [b](#a-word-two) [c](#three) [d](https://e)\n")
    assert dead_links(page) == ["](other.md)", "](#three)"]
