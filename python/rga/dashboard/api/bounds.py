"""How much is taken in: how fast a caller may send, and what a twin and the disk have room for."""

import shutil
import time
from collections import OrderedDict
from collections.abc import Callable
from threading import Lock

from rga.dashboard.surroundings import SeenTwin
from rga.errors import InputError

#: calls a second of one caller in the long run, and at once
RATE, BURST = 500.0, 5_000.0
#: callers that are remembered
MOST_CALLERS = 10_000
#: bytes of the disk that are kept free
RESERVE = 64 * 2**20
#: rows that may wait to be played
MOST_WAITING = 100_000
#: how long it is believed what was found of room [s]
BELIEVED = 1.0


class RateLimit:
    """Lets every caller send so often.

    Args:
        rate: calls a second in the long run.
        burst: calls at once.
        clock: seconds, rising.

    >>> limit = RateLimit(1.0, 2.0, clock=iter([0.0, 0.0, 0.0, 3.0]).__next__)
    >>> [limit.wait_of("logger") for _ in range(4)]
    [0.0, 0.0, 1.0, 0.0]
    """

    def __init__(
        self, rate: float = RATE, burst: float = BURST, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()
        self._lock = Lock()

    def wait_of(self, caller: str) -> float:
        """How long a caller has to wait [s]; 0: the call counts."""
        with self._lock:
            now = self._clock()
            left, since = self._left.pop(caller, (self._burst, now))
            left = min(self._burst, left + (now - since) * self._rate)
            wait = 0.0 if left >= 1 else (1 - left) / self._rate
            self._left[caller] = (left if wait else left - 1, now)
            if len(self._left) > MOST_CALLERS:
                self._left.popitem(last=False)
            return wait


class IntakeRoom:
    """Whether a twin has room for more.

    Args:
        clock: seconds, rising.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._found: dict[str, tuple[float, str | None]] = {}

    def lacking(self, seen: SeenTwin) -> str | None:
        """Why nothing more is taken in for now; None: it is."""
        now = self._clock()
        found = self._found.get(seen.name)
        if found is None or now - found[0] > BELIEVED:
            found = self._found[seen.name] = (now, _lacking(seen))
        return found[1]


def _lacking(seen: SeenTwin) -> str | None:
    free = shutil.disk_usage(seen.served.directory).free
    if free < RESERVE:
        return f"the disk has {free // 2**20} MiB left"
    try:
        lag = seen.lag(seen.reading.now())
    except InputError:
        # The inbox is the buffer for when the repository is away.
        return None
    return None if lag <= MOST_WAITING else f"{lag} rows wait to be played"
