"""Takes a live twin up in a process of its own, which loads nothing else, and says what it took."""

import json
import resource
import sys
import time
from pathlib import Path

import rga


def largest_memory() -> int:
    """Of this process so far [B]."""
    status = Path("/proc/self/status")
    if status.exists():
        # What the system counts as the usage of a process begins with that of its parent.
        lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
        return 1024 * int(lines["VmHWM"].split()[0])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def take_up(directory: str) -> None:
    """Take a run up, and write time and memory to the standard output."""
    opened = rga.LiveTwin  # it is loaded on first use
    loaded, begun = largest_memory(), time.perf_counter()
    with opened(directory) as twin:
        twin.play()
        seconds = time.perf_counter() - begun
    json.dump({"seconds": seconds, "memory": largest_memory(), "loaded": loaded}, sys.stdout)


if __name__ == "__main__":
    take_up(sys.argv[1])
