"""A table as words."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rich.table import Table
from rich.text import Text


@dataclass(frozen=True)
class TextTable:
    """A table as words.

    Attributes:
        title: above it; "": none.
        headings: of the columns.
        rows: cells; one alone among several columns is the heading of the rows below it.
        numbers: whether all columns but the first one are set to the right.
    """

    title: str
    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: bool = False

    def terminal(self) -> Table:
        """For rich."""
        table = Table(title=Text(self.title) if self.title else None, title_justify="left")
        for number, heading in enumerate(self.headings):
            side: Literal["right", "left"] = "right" if self.numbers and number else "left"
            table.add_column(Text(heading), justify=side, no_wrap=number == 0)
        for row in self.rows:
            section = self._is_section(row)
            if section:
                table.add_section()
            table.add_row(*(Text(cell, style="bold" if section else "") for cell in row))
        return table

    def markdown(self) -> list[str]:
        """Lines of a page."""
        rule = ["---"] + ["---:" if self.numbers else "---"] * (len(self.headings) - 1)
        title = [f"## {self.title}", ""] if self.title else []
        return [*title, *map(self._line, [self.headings, rule, *self.rows]), ""]

    def _is_section(self, row: Sequence[str]) -> bool:
        return len(row) < len(self.headings)

    def _line(self, row: Sequence[str]) -> str:
        if self._is_section(row):
            row = [f"**{row[0]}**", *[""] * (len(self.headings) - 1)]
        return f"| {' | '.join(row)} |"
