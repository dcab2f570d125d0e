"""Progress on the error stream."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID


class Shown:
    """Bars for the stages of a long task; called with a stage and the share of it that is done."""

    def __init__(self, bars: "Progress") -> None:
        self._bars = bars
        self._stages: dict[str, TaskID] = {}

    def __call__(self, stage: str, done: float) -> None:
        self._bars.update(self._task(stage), completed=done)

    def describe(self, stage: str, words: str) -> None:
        """Put words in the place of the name of a stage."""
        from rich.markup import escape

        self._bars.update(self._task(stage), description=escape(words))

    def _task(self, stage: str) -> "TaskID":
        if stage not in self._stages:
            self._stages[stage] = self._bars.add_task(stage, total=1.0)
        return self._stages[stage]


@contextmanager
def shown_progress() -> Iterator[Shown]:
    """Bars on the error stream; silent where nobody watches."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bars:
        yield Shown(bars)
