"""Pages of benchmarks, in a file and in a terminal."""

import io

from rich.console import Console

from rga_bench.page import MarkdownPage, Page, PlainPage
from rga_bench.text_table import TextTable

TABLE = TextTable(
    "Costs",
    ["policy", "RG [mm²]"],
    [["null twin"], ["event", "0.090"], ["time, 40 rows", "1.5"]],
    numbers=True,
)


def shown(page: Page) -> list[str]:
    """Lines of a terminal of 40 columns."""
    console = Console(file=io.StringIO(), width=40)
    for part in page.terminal():
        console.print(part, crop=False)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().splitlines()


def test_a_page_has_its_parts_in_order() -> None:
    page = MarkdownPage(
        "costs.md",
        "What it costs",
        "`rga benchmark costs`",
        ["one core"],
        ["What is meant.", TABLE],
        {"costs.png": "costs"},
    )
    assert page.text() == (
        "# What it costs\n\n`rga benchmark costs`\n\n- one core\n\nWhat is meant.\n\n"
        "## Costs\n\n| policy | RG [mm²] |\n| --- | ---: |\n| **null twin** |  |\n"
        "| event | 0.090 |\n| time, 40 rows | 1.5 |\n\n![costs](costs.png)\n"
    )
    lines = shown(page)
    assert lines[:3] == ["one core", "What is meant.", ""]
    assert lines[3].strip() == "Costs"
    # Units in brackets are no markup, and numbers are set to the right.
    (heading,) = [line for line in lines if "RG [mm²]" in line]
    ends = {len(line.rstrip(" │┃")) for line in lines if "0.090" in line or "1.5" in line}
    assert ends == {len(heading.rstrip(" │┃"))}


def test_a_table_without_a_title_has_no_heading() -> None:
    assert TextTable("", ["a"], [["1"]]).markdown()[0] == "| a |"


def test_plain_tables_are_not_broken() -> None:
    tables = f"{'wide ' * 20}\n[not markup]\n"
    page = PlainPage("tables.txt", tables)
    assert page.text() == tables
    assert "\n".join(shown(page)).rstrip() == tables.rstrip()
