"""A page of results, for a file and for a terminal."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from rich.console import Group, RenderableType
from rich.text import Text

from rga_bench.text_table import TextTable


class Page(Protocol):
    """A page of results."""

    @property
    def file(self) -> str:
        """Its name."""

    def text(self) -> str:
        """What the file holds."""

    def terminal(self) -> Iterator[RenderableType]:
        """Its parts for rich."""


@dataclass(frozen=True)
class MarkdownPage:
    """Tables, and what is said about them.

    Attributes:
        file: its name.
        title: above it.
        origin: the command, and where it says so, day and conditions.
        about: lines: the machine, and what was measured.
        parts: tables, and paragraphs between them.
        figures: what the figures beside the page show, by file name.
    """

    file: str
    title: str
    origin: str
    about: Sequence[str]
    parts: Sequence[TextTable | str]
    figures: Mapping[str, str] = field(default_factory=dict)

    def text(self) -> str:
        """Markdown."""
        lines = [f"# {self.title}", "", self.origin, "", *(f"- {one}" for one in self.about), ""]
        for part in self.parts:
            lines += part.markdown() if isinstance(part, TextTable) else [part, ""]
        for file, shown in self.figures.items():
            lines += [f"![{shown}]({file})", ""]
        return "\n".join(lines)

    def terminal(self) -> Iterator[RenderableType]:
        """Lines, tables and paragraphs."""
        yield from map(Text, self.about)
        for part in self.parts:
            yield part.terminal() if isinstance(part, TextTable) else Text(f"{part}\n")


@dataclass(frozen=True)
class PlainPage:
    """Tables in plain text.

    Attributes:
        file: its name.
        tables: what it holds.
    """

    file: str
    tables: str

    def text(self) -> str:
        """The tables."""
        return self.tables

    def terminal(self) -> Iterator[RenderableType]:
        """The tables, whose lines are not broken."""
        # In a group a text keeps its own rules of breaking.
        yield Group(Text(self.tables, no_wrap=True, overflow="ignore", end=""))
