"""What a process and those that it has started take of the machine."""

import os
from dataclasses import dataclass
from pathlib import Path

from rga.errors import InputError

_PROCESSES = Path("/proc")


@dataclass(frozen=True)
class Usage:
    """What processes have taken so far.

    Attributes:
        memory: that they hold now [B].
        processor: time of the processor [s].
        read: bytes that they have read, from files and from each other.
    """

    memory: int
    processor: float
    read: int


def usage_of(process: int) -> Usage:
    """Usage of a process with all that it has started and that run.

    Args:
        process: its number.

    Raises:
        InputError: the system does not tell.
    """
    if not (_PROCESSES / str(process) / "io").exists():
        raise InputError("the system does not tell", f"process {process}", "measure on Linux")
    every = [process]
    for one in every:
        for thread in (_PROCESSES / str(one) / "task").iterdir():
            every += [int(child) for child in (thread / "children").read_text("utf-8").split()]
    memory, processor, read = 0, 0.0, 0
    for one in every:
        folder = _PROCESSES / str(one)
        stated = dict(
            line.split(":", 1)
            for name in ("status", "io")
            for line in (folder / name).read_text("utf-8").splitlines()
        )
        # The name of the program, in brackets, may hold spaces.
        numbers = (folder / "stat").read_text("utf-8").rpartition(")")[2].split()
        memory += 1024 * int(stated["VmRSS"].split()[0])
        processor += (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")
        read += int(stated["rchar"])
    return Usage(memory, processor, read)


def stored(folder: Path) -> int:
    """Bytes of all files below a folder."""
    return sum(one.stat().st_size for one in folder.rglob("*") if one.is_file())
