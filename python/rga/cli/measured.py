"""What a benchmark found: a page and figures in a directory, JSON, and tables in the terminal."""

from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any, Protocol, TypeVar

from rich.console import Console, RenderableType

from rga.cli.output import whole_directory, write_json
from rga.cli.progress import shown_progress
from rga.errors import InputError

#: of a table, in a terminal that is narrower and in a file
WIDTH = 140

Result = TypeVar("Result")
Shown = TypeVar("Shown", contravariant=True)
Progress = Callable[[float], None]


class Tables(Protocol[Shown]):
    """The module of a benchmark that puts results into words."""

    def about(self, result: Shown, /) -> list[str]:
        """Lines about the machine, and what was measured."""

    def terminal(self, result: Shown, /) -> RenderableType:
        """Tables for rich."""

    def markdown(self, result: Shown, command: str, /) -> str:
        """A page."""


def measured(
    name: str,
    command: str,
    measure: Callable[[Progress], Result],
    tables: Tables[Result],
    draw: Callable[[Result, Path], None],
    content: Callable[[Result], dict[str, Any]],
    *,
    output: Path | None,
    json: str | None,
) -> None:
    """Measure, and print the result.

    Args:
        name: of the benchmark, and of its page.
        command: that makes the same again.
        measure: takes what is called with the share that is done.
        tables: what is found in words.
        draw: writes figures into a folder.
        content: what programs read.
        output: directory for the page and the figures.
        json: file for what programs read; "-": the terminal.
    """
    if json not in (None, "-") and Path(json).is_dir():
        # Said before the work is done.
        raise InputError("the output is a directory", json, "give a file")
    with nullcontext() if output is None else whole_directory(output) as draft:
        with shown_progress() as progress:
            result = measure(lambda done: progress(name, done))
        if draft is not None:
            page = tables.markdown(result, command)
            (draft / f"{name}.md").write_text(page, encoding="utf-8")
            draw(result, draft)
    if json is not None:
        write_json({"command": command, **content(result)}, json)
    if json != "-":
        console = Console()
        console.width = max(console.width, WIDTH)
        for line in tables.about(result):
            console.print(line, markup=False, highlight=False)
        console.print(tables.terminal(result))
