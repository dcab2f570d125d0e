"""A table as words."""

from collections.abc import Sequence
from dataclasses import dataclass

from rich.table import Table
from rich.text import Text


@dataclass(frozen=True)
class Sheet:
    """A table as words.

    Attributes:
        title: above it.
        headings: of the columns.
        rows: cells.
    """

    title: str
    headings: list[str]
    rows: list[list[str]]

    def terminal(self) -> Table:
        """For rich."""
        table = Table(title=Text(self.title), title_justify="left")
        for heading in self.headings:
            table.add_column(Text(heading))
        for row in self.rows:
            table.add_row(*(Text(cell) for cell in row))
        return table

    def markdown(self) -> list[str]:
        """Lines of a page."""
        rows = [self.headings, ["---"] * len(self.headings), *self.rows]
        return [f"## {self.title}", "", *map(_row, rows), ""]


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
