"""The command line: `rga`."""

import os
import sys
import time
from collections.abc import Sequence
from threading import Thread

from rga.cli.signals import Stopped, stopping

#: commands that go on where they were stopped
RESUMED = ("run", "dataset")
#: how long a command that was stopped may take to end [s]
PATIENCE = 5.0


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command and leave with its exit code: 0 done, 2 bad input, 1 fault.

    Where Ctrl-C or SIGTERM ends it, the code is 130 or 143.

    Args:
        arguments: as typed after `rga`; None: those of the process.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        with stopping(to_the_end=arguments is None):
            # Signals are minded before what takes a while to import.
            from rga.cli.app import run_command

            run_command(given)
    except Stopped as stopped:
        goes_on = "; the same command goes on where it stood" if {*given[:1]} & {*RESUMED} else ""
        sys.stderr.write(f"{stopped}{goes_on}\n")
        # Python would wait for ever for a thread that waits for a worker that was killed.
        Thread(target=_leave, args=(stopped.code,), daemon=True).start()
        sys.exit(stopped.code)


def _leave(code: int) -> None:
    time.sleep(PATIENCE)
    sys.stderr.flush()
    os._exit(code)


__all__ = ["main"]
