"""What was stored last is found without reading all that was stored before it."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import event
from sqlalchemy.engine import Engine

from rga.twin.repository import Repository, Run
from stored_runs import IDENTITY

FEW, MANY = 20, 400


class Effort:
    """Counts what SQLite does: instructions, ten at a time."""

    def __init__(self) -> None:
        self.instructions = 0

    def begin(self, connection: Any) -> None:
        """Count in the transaction that begins."""
        connection.connection.dbapi_connection.set_progress_handler(self._count, 10)

    def _count(self) -> int:
        self.instructions += 10
        return 0

    def of(self, read: Callable[[], object]) -> int:
        """What it takes to read something."""
        before = self.instructions
        read()
        return self.instructions - before


@pytest.fixture
def run_in_file(tmp_path: Path) -> Iterator[Run]:
    with Repository.open(tmp_path / "run.sqlite") as repository:
        yield repository.run(IDENTITY)


@pytest.mark.parametrize("name", ["rare", "frequent"])
def test_a_name_is_found_among_many_of_another(run_in_file: Run, name: str) -> None:
    effort = Effort()
    event.listen(Engine, "begin", effort.begin)
    try:
        with run_in_file.step() as step:
            step.keep("rare", b"once", 0)
        found = []
        for first, end in ((1, FEW), (FEW, MANY)):
            for row in range(first, end):
                with run_in_file.step() as step:
                    step.keep("frequent", b"again", row)
            found.append(effort.of(lambda: run_in_file.kept(name)))
    finally:
        event.remove(Engine, "begin", effort.begin)
    few, many = found
    assert many < 2 * few
