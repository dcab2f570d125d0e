"""The pages of the documentation, their blocks of code and the command lines in them."""

import os
import re
import runpy
import sys
from dataclasses import dataclass
from pathlib import Path

from rga.cli import main

ROOT = Path(__file__).parents[1]
#: what people wrote; the pages below a year in docs/results were written by benchmarks
PAGES = [
    ROOT / "README.md",
    *(page for page in sorted((ROOT / "docs").rglob("*.md")) if not page.match("results/*/*/*")),
]
BLOCK = re.compile(
    r"(?:^<!-- not run: (?P<reason>.+?) -->\n)?^```(?P<language>[\w{}-]*)\n(?P<code>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
SHELL = ("", "sh", "console", "bash")


@dataclass(frozen=True)
class CodeBlock:
    """A block between fences.

    Attributes:
        language: as it stands behind the fence.
        code: between the fences.
        reason: why it is not run, from a comment right before it; empty where it is.
    """

    language: str
    code: str
    reason: str


def blocks(page: Path) -> list[CodeBlock]:
    """The blocks of a page, in their order."""
    found = BLOCK.finditer(page.read_text(encoding="utf-8"))
    return [CodeBlock(one["language"], one["code"], one["reason"] or "") for one in found]


def command_lines(page: Path) -> list[str]:
    """Every line in a block, and every span in the text, that begins with `rga `."""
    lines = [
        line.removeprefix("$ ")
        for block in blocks(page)
        if block.language in SHELL
        for line in block.code.splitlines()
    ]
    prose = BLOCK.sub("", page.read_text(encoding="utf-8"))
    spans = [" ".join(one.split()) for one in re.findall(r"`(rga [^`]+)`", prose)]
    return [line for line in [*lines, *spans] if line.startswith("rga ")]


def run_command(*words: str) -> None:
    """A line `rga ...` of a page, in the process of its script."""
    try:
        main(words)
    except SystemExit as left:
        # The script goes on, unless the command failed.
        if left.code:
            raise


def play(script: Path) -> None:
    """Run a script in its folder, in a process of its own; what it says stands beside it."""
    os.chdir(script.parent)
    os.environ["MPLBACKEND"] = "Agg"
    for stream, name in ((sys.stdout, "printed"), (sys.stderr, "told")):
        os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT), stream.fileno())
    sys.argv = [str(script)]
    runpy.run_path(str(script), run_name="__main__")
