"""What was stored last is found without reading all that was stored before it."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sqlalchemy import event
from sqlalchemy.engine import Engine

from rga.twin.repository import Repository, Run, RunView
from rga.twin.repository.chunks import LONGEST
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


@pytest.fixture
def effort() -> Iterator[Effort]:
    found = Effort()
    event.listen(Engine, "begin", found.begin)
    yield found
    event.remove(Engine, "begin", found.begin)


@pytest.mark.parametrize("name", ["rare", "frequent"])
def test_a_name_is_found_among_many_of_another(run_in_file: Run, name: str, effort: Effort) -> None:
    with run_in_file.step() as step:
        step.keep("rare", b"once", 0)
    found = []
    for first, end in ((1, FEW), (FEW, MANY)):
        for row in range(first, end):
            with run_in_file.step() as step:
                step.keep("frequent", b"again", row)
        found.append(effort.of(lambda: run_in_file.kept(name)))
    few, many = found
    assert many < 2 * few


@pytest.mark.parametrize("width", [0, 3], ids=["forgotten", "kept"])
def test_rows_are_read_alone_as_they_stood_at_a_step(
    run_in_file: Run, effort: Effort, width: int
) -> None:
    found = []
    with run_in_file.step() as step:
        step.measured(0, np.arange(LONGEST), np.zeros((LONGEST, 3)), np.zeros((LONGEST, 0)))
    for first, end in ((1, FEW), (FEW, MANY)):
        for packet in range(first, end):
            time = np.arange(packet * LONGEST, (packet + 1) * LONGEST, dtype=float)
            none = np.zeros((LONGEST, 0))
            with run_in_file.step() as step:
                step.measured(len(time) * packet, time, np.zeros((LONGEST, width)), none)
                step.gaps(len(time) * packet, none, none, version=1)
        view = run_in_file.at_step(run_in_file.steps)
        found.append(effort.of(partial(_read, view, end * LONGEST - 1)))
    few, many = found
    assert many < 2 * few


def test_messages_of_a_kind_are_found_among_many_of_others(
    run_in_file: Run, effort: Effort
) -> None:
    found = []
    with run_in_file.step() as step:
        step.message(kind="R1", row=0, body={})
    for first, end in ((1, FEW), (FEW, MANY)):
        for row in range(first, end):
            with run_in_file.step() as step:
                step.message(kind="R5", row=row, body={})
        view = run_in_file.at_step(run_in_file.steps)
        found.append(effort.of(partial(view.messages, "R1")))
        assert len(view.messages("R1")) == 1
    few, many = found
    assert many < 2 * few


def _read(view: RunView, last: int) -> None:
    assert view.row_at(5.0) == 5
    assert view.measured_at([7, last]).rows.tolist() == [7, last]
    assert view.packets_about([7, last]) == [(0, LONGEST), (last + 1 - LONGEST, last + 1)]
    assert view.measured(last).readings.shape == (1, 3)
    assert len(view.gaps(last).rows) == 1
