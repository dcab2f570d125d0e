"""The ledger of a benchmark: a line for every finished task, so that none is done twice."""

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, ClassVar, Generic, Protocol, TypeVar

from pydantic import TypeAdapter

import rga
from rga.errors import InputError
from rga.parallel import finished

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
def versions() -> dict[str, str]:
    """Versions that an outcome depends on; `code` is the hash of both packages as they stand."""
    root = Path(rga.__file__).parents[1]
    content = hashlib.sha256()
    files = [path for name in ("rga", "rga_bench") for path in (root / name).rglob("*.py")]
    for path in sorted([*files, *(root / "rga").glob("_core*")]):
        if path.suffix != ".pyi":
            content.update(path.relative_to(root).as_posix().encode() + path.read_bytes())
    return {
        **{name: version(name) for name in ("rga", "numpy", "scipy")},
        "code": content.hexdigest()[:16],
    }


class Ledger(Generic[Outcome]):
    """Outcomes in a folder, one JSON object a line.

    Args:
        folder: is made where it is missing.
        kind: of the outcomes.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of other code.
    """

    def __init__(self, folder: Path, kind: type[Outcome]) -> None:
        self._path, self._kind = folder / NAME, TypeAdapter(kind)
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
        line = {"versions": versions(), **asdict(outcome)}
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
            if own == versions():
                return self._kind.validate_python(content)
        except (ValueError, TypeError, KeyError, AttributeError):
            raise InputError(
                "this is no outcome of this benchmark", where, "give a new folder"
            ) from None
        differs = ", ".join(
            f"{name} {own.get(name)}, now {now}"
            for name, now in versions().items()
            if own.get(name) != now
        )
        raise InputError(
            f"these outcomes are of another version: {differs}", where, "give a new folder"
        )


def outcomes_of(
    function: Callable[[Task], Outcome],
    tasks: Sequence[Task],
    kind: type[Outcome],
    *,
    folder: Path | None = None,
    workers: int = 1,
    dask: str | None = None,
    going: Callable[[], bool] = lambda: True,
    progress: Callable[[float], None] = lambda done: None,
) -> list[Outcome]:
    """What becomes of tasks; none that a ledger holds is done again.

    Args:
        function: of a module that the processes can import; an outcome has the name of its task.
        tasks: in the order in which they are begun; they can be pickled.
        kind: of the outcomes.
        folder: keeps the outcomes.
        workers: processes at work on this machine.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead.
        going: whether further tasks are begun.
        progress: told the share that is done.

    Returns:
        The outcomes that there are, in the order of the tasks.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of another version; or there is
            no cluster.
    """
    ledger = Ledger(folder, kind) if folder is not None else None
    known = dict(ledger.outcomes) if ledger is not None else {}
    missing: Iterable[Task] = (one for one in tasks if one.id not in known and going())
    for _, done in finished(function, missing, workers=workers, dask=dask):
        outcome = done.result()
        known[outcome.id] = outcome
        if ledger is not None:
            ledger.add(outcome)
        progress(sum(one.id in known for one in tasks) / len(tasks))
    return [known[one.id] for one in tasks if one.id in known]
