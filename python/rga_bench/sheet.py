"""A table as words."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rich.table import Table
from rich.text import Text


@dataclass(frozen=True)
class Sheet:
    """A table as words.

    Attributes:
        title: above it; "": none.
        headings: of the columns.
        rows: cells; a row of one cell is the heading of those below it.
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
            if len(row) == 1:
                table.add_section()
            table.add_row(*(Text(cell, style="bold" if len(row) == 1 else "") for cell in row))
        return table

    def markdown(self) -> list[str]:
        """Lines of a page."""
        rule = ["---"] + ["---:" if self.numbers else "---"] * (len(self.headings) - 1)
        title = [f"## {self.title}", ""] if self.title else []
        return [*title, *map(self._line, [self.headings, rule, *self.rows]), ""]

    def _line(self, row: Sequence[str]) -> str:
        if len(row) == 1:
            row = [f"**{row[0]}**", *[""] * (len(self.headings) - 1)]
        return f"| {' | '.join(row)} |"
