"""A benchmark: what is measured under which settings, and what is shown of it."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

if TYPE_CHECKING:
    from rga_bench.page import Page

Result = TypeVar("Result")


@dataclass(frozen=True)
class Execution:
    """How tasks are run; no result depends on it, but for times.

    Attributes:
        folder: keeps outcomes of tasks; those that it holds already are not made again.
        workers: processes at work on this machine.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead.
        minutes: after which no further task is begun; None: all are.
        progress: called with the share that is done.
    """

    folder: Path | None = None
    workers: int = 1
    dask: str | None = None
    minutes: float | None = None
    progress: Callable[[float], None] = lambda done: None


class Experiment(ABC, Generic[Result]):
    """What a benchmark measures: its settings, which its quick form has as well.

    Tasks that stand alone are run by `outcomes_of` (`rga_bench.ledger`).

    Attributes:
        name: of its command.
        options: of its command that make the same again, beside `--quick` and `--seed`.
    """

    name: ClassVar[str]
    options: str = ""

    @abstractmethod
    def measure(self, execution: Execution) -> Result:
        """Run all tasks, each of them once.

        Raises:
            InputError: the folder cannot be used, or holds outcomes of another version; or there
                is no cluster.
        """

    @abstractmethod
    def page(self, result: Result, command: str) -> "Page":
        """The tables, and what is said about them.

        Args:
            result: what was measured.
            command: that measures the same again.
        """

    @abstractmethod
    def write_figures(self, result: Result, folder: Path) -> None:
        """Write what stands beside the page to a folder."""

    @abstractmethod
    def content(self, result: Result, command: str) -> dict[str, Any]:
        """What programs read, as JSON can hold it."""
