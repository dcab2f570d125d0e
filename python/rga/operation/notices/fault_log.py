"""What keeps sources and rows from going on, as lines for whoever reads the log of the service."""

import time
from collections.abc import Callable, Mapping

#: how long a fault lasts before it is worth a line, so that a beginning is none [s]
LASTS = 5.0


class FaultLog:
    """Says a fault once, each reason for it once, and its end.

    Args:
        said: takes a line.
        clock: seconds, rising.

    >>> lines, now = [], iter([0.0, 9.0, 18.0])
    >>> log = FaultLog(lines.append, lambda: next(now))
    >>> for faults in ({("east", "mqtt"): "away"}, {("east", "mqtt"): "away"}, {}):
    ...     log.observe(faults)
    >>> lines
    ['twin east, mqtt: away', 'twin east, mqtt: goes on']
    """

    def __init__(
        self, said: Callable[[str], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._say, self._clock = said, clock
        self._since: dict[tuple[str, str], float] = {}
        self._said: dict[tuple[str, str], set[str]] = {}

    def observe(self, faults: Mapping[tuple[str, str], str]) -> None:
        """Look at what is wrong now, in words, by twin and source."""
        now = self._clock()
        for place, words in faults.items():
            said = self._said.setdefault(place, set())
            if now - self._since.setdefault(place, now) >= LASTS and words not in said:
                said.add(words)
                self._say(f"{_named(*place)}: {' '.join(words.split())}")
        for place in self._since.keys() - faults.keys():
            del self._since[place]
            if self._said.pop(place):
                self._say(f"{_named(*place)}: goes on")


def _named(twin: str, what: str) -> str:
    return f"twin {twin}, {what}" if twin else f"service, {what}"
