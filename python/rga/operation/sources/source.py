"""What a service knows of where data comes from, whatever kind it is."""

from collections.abc import Callable, Mapping, Sequence
from threading import Event, Thread
from typing import Any, Protocol

from rga.errors import InputError
from rga.operation.inbox.arrival import Outcome
from rga.operation.inbox.numbers import Numbers

#: the place that a payload came from, and the payload
Placed = tuple[str, bytes]


class DataSource(Protocol):
    """Brings data until it is stopped, whatever happens where the data comes from."""

    @property
    def fault(self) -> str | None:
        """What keeps data from coming, in words; None: nothing."""

    def start(self) -> None:
        """Begin to bring data; it returns at once."""

    def stop(self) -> None:
        """Bring no more data; what was brought is kept when it returns."""


class Inlet(Protocol):
    """Keeps what one source brings."""

    def receive(
        self, payloads: Sequence[Placed], cursor: Mapping[str, Any] | None = None
    ) -> list[Outcome]:
        """Keep payloads, and in the same transaction where the source reads on.

        Returns:
            What becomes of each, and why if it is refused.

        Raises:
            InputError: nothing of them is kept, for now.
        """

    def receive_lines(
        self, where: str, head: bytes, lines: bytes, cursor: Mapping[str, Any]
    ) -> list[Outcome]:
        """Keep lines of a file as `receive` does, those that cannot be used apart from the others.

        Args:
            where: the file.
            head: lines above all rows.
            lines: of rows, each with its end.
            cursor: where the source reads on.
        """

    def cursor(self) -> dict[str, Any]:
        """Where the source reads on, by its parts."""

    def numbers(self) -> dict[str, Numbers]:
        """The numbers that have come of each stream."""


class Polling:
    """A source that is looked at again and again, in a thread of its own.

    Args:
        name: of the thread.
        look: brings what is new until the event is set, and gives what is wrong beside it, in
            words. It may fail: it is called again.
        every: how often [s].
    """

    def __init__(self, name: str, look: Callable[[Event], str | None], every: float) -> None:
        self._look, self._every = look, every
        self._ending = Event()
        self._thread = Thread(target=self._work, name=name, daemon=True)
        self.fault: str | None = None

    def start(self) -> None:
        """Begin to look."""
        self._thread.start()

    def stop(self) -> None:
        """Look no more, when what is under way is kept."""
        self._ending.set()
        if self._thread.ident is not None:
            self._thread.join()

    def _work(self) -> None:
        while not self._ending.is_set():
            self.fault = attempt(lambda: self._look(self._ending))
            self._ending.wait(self._every)


def attempt(does: Callable[[], str | None]) -> str | None:
    """Do something that is done again soon, whatever keeps it from being done now.

    Returns:
        What it says is wrong, or what kept it from being done; None: nothing.

    >>> attempt(lambda: None), attempt(lambda: str(1 / 0))
    (None, 'ZeroDivisionError: division by zero')
    """
    try:
        return does()
    except (InputError, OSError) as error:
        return str(error) or type(error).__name__
    except Exception as error:  # A thread that ends would bring nothing more, and say nothing.
        return f"{type(error).__name__}: {error}"
