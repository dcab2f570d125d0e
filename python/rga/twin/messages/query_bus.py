"""Query and response: the one way between the analysis, the twin and the repository."""

from collections.abc import Callable
from typing import overload

from rga.twin.archive import Archive
from rga.twin.digital_twin import DigitalTwin
from rga.twin.messages.queries import (
    Q1,
    Q2,
    Q3,
    Q4,
    Q5,
    R1,
    R2,
    R3,
    R4,
    R5,
    Message,
    Query,
    Response,
)

Log = Callable[[Message], None]


class QueryResponse:
    """Takes a query to whom it concerns, writes both into the log, and lets the twin follow.

    Args:
        twin: answers Q1, Q3 and Q5.
        archive: answers Q2 and Q4.
    """

    def __init__(self, twin: DigitalTwin, archive: Archive) -> None:
        self.twin = twin
        self._archive = archive

    @overload
    def ask(self, query: Q1) -> R1: ...
    @overload
    def ask(self, query: Q2) -> R2: ...
    @overload
    def ask(self, query: Q3) -> R3: ...
    @overload
    def ask(self, query: Q4) -> R4: ...
    @overload
    def ask(self, query: Q5) -> R5: ...

    def ask(self, query: Query) -> Response:
        """The response to a query."""
        self._archive.log(query)
        if isinstance(query, Q2 | Q4):
            response: Response = self._archive.answer(query)
        else:
            response = self.twin.answer(query)
        self._archive.take(response)
        self.twin.accept(response)
        return response
