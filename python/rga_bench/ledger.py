"""The ledger of a benchmark: a line for every finished task, so that none is done twice."""

import json
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from math import inf
from pathlib import Path
from typing import Any, ClassVar, Generic, Protocol, TypeVar

from pydantic import TypeAdapter

from rga.errors import InputError
from rga.parallel import finished
from rga_bench.experiment import Execution
from rga_bench.task_code import code_hash

NAME = "outcomes.jsonl"


class Identified(Protocol):
    """Something that has a name of its own."""

    @property
    def id(self) -> str:
        """The name."""


class Kept(Identified, Protocol):
    """A dataclass of what JSON can hold."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


Task = TypeVar("Task", bound=Identified)
Outcome = TypeVar("Outcome", bound=Kept)


@cache
def task_versions(function: Callable[..., Any]) -> dict[str, str]:
    """Versions that the outcome of a task depends on.

    Args:
        function: does the task; `code` is the hash of all that its module imports.
    """
    return {
        **{name: version(name) for name in ("rga", "numpy", "scipy")},
        "code": code_hash(function.__module__),
    }


class Ledger(Generic[Outcome]):
    """Outcomes in a folder, one JSON object a line.

    Args:
        folder: is made where it is missing.
        kind: of the outcomes.
        versions: that they depend on.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of other versions.
    """

    def __init__(self, folder: Path, kind: type[Outcome], versions: dict[str, str]) -> None:
        self._path, self._kind, self._versions = folder / NAME, TypeAdapter(kind), versions
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._path.touch()
            text = self._path.read_text(encoding="utf-8")
        except OSError as error:
            reason = (error.strerror or "refused").lower()
            raise InputError(
                f"the outcomes cannot be kept, {reason}", str(folder), "give another place"
            ) from None
        whole = text[: text.rfind("\n") + 1]
        if len(whole) < len(text):
            # The line that an interruption cut off.
            os.truncate(self._path, len(whole.encode()))
        self.outcomes = {
            one.id: one
            for number, line in enumerate(whole.splitlines(), 1)
            for one in (self._read(line, number),)
        }

    def add(self, outcome: Outcome) -> None:
        """Write an outcome down."""
        line = asdict(outcome)
        assert "versions" not in line  # it is that of the ledger
        line = {"versions": self._versions, **line}
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line, allow_nan=False) + "\n")
            file.flush()
            os.fsync(file.fileno())
        self.outcomes[outcome.id] = outcome

    def _read(self, line: str, number: int) -> Outcome:
        where = f"{self._path}, line {number}"
        try:
            content: dict[str, Any] = json.loads(line)
            own = dict(content.pop("versions"))
            if own == self._versions:
                return self._kind.validate_python(content)
        except (ValueError, TypeError, KeyError, AttributeError):
            raise InputError(
                "this is no outcome of this benchmark", where, "give a new folder"
            ) from None
        differs = ", ".join(
            f"{name} {own.get(name)}, now {now}"
            for name, now in self._versions.items()
            if own.get(name) != now
        )
        raise InputError(
            f"these outcomes are of another version: {differs}", where, "give a new folder"
        )


def outcomes_of(
    function: Callable[[Task], Outcome],
    tasks: Sequence[Task],
    kind: type[Outcome],
    execution: Execution,
) -> list[Outcome]:
    """What becomes of tasks; none that a ledger holds is done again.

    Args:
        function: of a module that the processes can import; an outcome has the name of its task.
        tasks: in the order in which they are begun; they can be pickled.
        kind: of the outcomes.
        execution: how the tasks are run.

    Returns:
        The outcomes that there are, in the order of the tasks.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of another version; or there is
            no cluster.
    """
    folder, minutes = execution.folder, execution.minutes
    until = inf if minutes is None else time.monotonic() + 60.0 * minutes
    ledger = None if folder is None else Ledger(folder, kind, task_versions(function))
    known = {} if ledger is None else dict(ledger.outcomes)
    missing = (one for one in tasks if one.id not in known and time.monotonic() < until)
    for _, done in finished(function, missing, workers=execution.workers, dask=execution.dask):
        outcome = done.result()
        known[outcome.id] = outcome
        if ledger is not None:
            ledger.add(outcome)
        execution.progress(sum(one.id in known for one in tasks) / len(tasks))
    return [known[one.id] for one in tasks if one.id in known]
