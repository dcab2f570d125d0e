"""Progress on the error stream."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def shown_progress() -> Iterator[Callable[[str, float], None]]:
    """A callback for a stage and the share of it that is done; silent where nobody watches."""
    from rich.console import Console
    from rich.progress import Progress, TaskID

    console = Console(stderr=True)
    stages: dict[str, TaskID] = {}
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bars:

        def show(stage: str, done: float) -> None:
            if stage not in stages:
                stages[stage] = bars.add_task(stage, total=1.0)
            bars.update(stages[stage], completed=done)

        yield show
