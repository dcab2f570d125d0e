"""Those who look at a bridge: each follows its stream, and loads its page again at every row."""

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Condition, Thread
from urllib.request import urlopen

from rga.errors import InputError
from rga_bench.operation.row_by_row import TWIN

#: how long a row is waited for [s]
LONGEST = 60.0
#: what a page says of the rows that it shows
SHOWN = re.compile(r"([0-9]+) rows, the newest")


class Viewers:
    """So many who look at a bridge.

    Args:
        address: of the service.
        count: how many.
    """

    def __init__(self, address: str, count: int) -> None:
        self._address, self._changed = address, Condition()
        self._told, self._shown = [0] * count, [0] * count
        self._is_ending = False
        self._threads = [Thread(target=self._look, args=[k], daemon=True) for k in range(count)]

    def start(self) -> None:
        """Begin to look, and wait until all do."""
        for thread in self._threads:
            thread.start()
        self.wait_shown(1)

    def stop(self) -> None:
        """End with the next row."""
        self._is_ending = True

    def wait_told(self, rows: int) -> None:
        """Wait until all are told of so many rows by the stream."""
        self._wait(self._told, rows)

    def wait_shown(self, rows: int) -> None:
        """Wait until the pages of all show so many rows."""
        self._wait(self._shown, rows)

    def _wait(self, seen: list[int], rows: int) -> None:
        with self._changed:
            if not self._changed.wait_for(lambda: min(seen) >= rows, LONGEST):
                raise InputError(f"row {rows} is not seen", self._address, "look at its log")

    def _look(self, number: int) -> None:
        with urlopen(f"{self._address}{TWIN}/stream", timeout=LONGEST) as stream:
            kind = ""
            for line in stream:
                name, _, value = line.decode().partition(": ")
                if name == "event":
                    kind = value.strip()
                elif name == "data" and kind == "row":
                    self._see(self._told, number, json.loads(value)["now"]["rows"])
                    self._see(self._shown, number, shown_rows(self._address))
                    if self._is_ending:
                        return

    def _see(self, seen: list[int], number: int, rows: int) -> None:
        with self._changed:
            seen[number] = rows
            self._changed.notify_all()


def shown_rows(address: str) -> int:
    """How many rows the page of the bridge shows."""
    with urlopen(f"{address}/twins/east", timeout=LONGEST) as answer:
        found = SHOWN.search(answer.read().decode())
    return 0 if found is None else int(found[1])


@contextmanager
def viewers(address: str, count: int) -> Iterator[Viewers]:
    """So many who look at a bridge meanwhile.

    Args:
        address: of the service.
        count: how many.
    """
    found = Viewers(address, count)
    found.start()
    try:
        yield found
    finally:
        found.stop()
