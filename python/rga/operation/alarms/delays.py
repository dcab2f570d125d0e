"""How long something has to be wrong, or well again, before anybody hears of it."""

from collections.abc import Mapping

from rga.operation.alarms.condition import ConditionKey

#: a condition, and whether it is there: what its alarm does not say yet
News = tuple[ConditionKey, bool]


class Delays:
    """How long news have been waiting to be told.

    >>> down = ConditionKey("east", "source", "down", "http"), True
    >>> delays = Delays()
    >>> [delays.passed("east", {down: 60.0}, at) for at in (0.0, 59.0)]
    [[], []]
    >>> delays.passed("east", {down: 60.0}, 60.0) == [down]
    True
    >>> delays.passed("east", {}, 61.0), delays.passed("east", {down: 60.0}, 62.0)
    ([], [])
    """

    def __init__(self) -> None:
        self._since: dict[str | None, dict[News, float]] = {}

    def passed(self, twin: str | None, waiting: Mapping[News, float], now: float) -> list[News]:
        """The news that have waited long enough; what does not wait any more begins anew.

        Args:
            twin: that they are all of.
            waiting: news, and how long each has to wait [s].
            now: by the monotonic clock [s].
        """
        before = self._since.get(twin, {})
        since = self._since[twin] = {one: before.get(one, now) for one in waiting}
        return [one for one, delay in waiting.items() if now - since[one] >= delay]
