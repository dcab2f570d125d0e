"""Ctrl-C, and the signal by which a system ends a process, as an error that cleans up."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

#: signals that end a command, in words
ENDING = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}
#: time to clean up, after which the error comes again: libraries in C may have swallowed it [s]
AGAIN = 2.0


class Stopped(BaseException):
    """A signal has come. No KeyboardInterrupt: the parser of the command line takes those.

    Attributes:
        number: of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number

    @property
    def code(self) -> int:
        """Exit code, as shells count it."""
        return 128 + self.number

    def __str__(self) -> str:
        return ENDING[signal.Signals(self.number)]


@contextmanager
def stopping(to_the_end: bool = False) -> Iterator[None]:
    """Signals raise `Stopped` within the block; a second one ends the process at once.

    Args:
        to_the_end: whether the process ends behind the block, and then minds no signal any more.

    Raises:
        Stopped: a signal has come.
    """
    if current_thread() is not main_thread():
        yield
        return
    came: list[int] = []

    def stop(number: int, _frame: FrameType | None) -> None:
        for one in ENDING:
            signal.signal(one, signal.SIG_DFL)
        came.append(number)
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGALRM, again)
            signal.setitimer(signal.ITIMER_REAL, AGAIN, AGAIN)
        raise Stopped(number)

    def untold(passed_over: "UnraisableHookArgs") -> None:
        # Where Python passes an error over, the signal comes again: there is nothing to tell.
        if not isinstance(passed_over.exc_value, Stopped):
            told(passed_over)

    def again(_number: int, _frame: FrameType | None) -> None:
        raise Stopped(came[0])

    told, sys.unraisablehook = sys.unraisablehook, untold
    before = {number: signal.signal(number, stop) for number in ENDING}
    try:
        yield
    except Exception as error:
        if not came:
            raise
        # Libraries in C, as they begin, make another error of it.
        raise Stopped(came[0]) from error
    finally:
        sys.unraisablehook = told
        if came and hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before.items():
            signal.signal(number, signal.SIG_IGN if to_the_end else handler)
