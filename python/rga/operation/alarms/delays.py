"""How long something has to be wrong, or well again, before anybody hears of it."""

from collections.abc import Mapping

from rga.operation.alarms.condition import ConditionKey


class Delays:
    """How long changes of conditions have been waiting to be told.

    >>> key = ConditionKey("east", "source", "down", "http")
    >>> delays = Delays()
    >>> [delays.passed("east", {key: 60.0}, at) for at in (0.0, 59.0)]
    [set(), set()]
    >>> delays.passed("east", {key: 60.0}, 60.0) == {key}
    True
    >>> delays.passed("east", {}, 61.0), delays.passed("east", {key: 60.0}, 62.0)
    (set(), set())
    """

    def __init__(self) -> None:
        self._since: dict[str | None, dict[ConditionKey, float]] = {}

    def passed(
        self, twin: str | None, waiting: Mapping[ConditionKey, float], now: float
    ) -> set[ConditionKey]:
        """The conditions that have waited long enough; what does not wait any more begins anew.

        Args:
            twin: that they are all of.
            waiting: conditions whose alarm says otherwise, and how long each has to wait [s].
            now: by the monotonic clock [s].
        """
        before = self._since.get(twin, {})
        since = self._since[twin] = {key: before.get(key, now) for key in waiting}
        return {key for key, delay in waiting.items() if now - since[key] >= delay}
