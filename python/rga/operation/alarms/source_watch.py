"""Whether sources still send, all of it, what can be used, by a clock that can be believed."""

from collections.abc import Mapping, Sequence
from datetime import timedelta

from rga.errors import in_a_line
from rga.operation.alarms.condition import Condition, ConditionKey
from rga.operation.inbox.numbers import Numbers
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock
from rga.operation.sources.clock import in_words
from rga.quantities import counted

#: channels that words name
MOST_NAMED = 5


class SourceWatch:
    """Looks at the sources of a twin.

    Args:
        twin: that they belong to.
        sources: names of them.
        patience: after which a source that sends nothing is down [s].
        lateness: for which a packet that is missing may still come [s].
        clock: of the service.
    """

    def __init__(
        self,
        twin: ServedTwin,
        sources: Sequence[str],
        patience: float,
        lateness: float,
        clock: ServiceClock,
    ) -> None:
        self._twin, self._sources, self._clock = twin, tuple(sources), clock
        self._patience, self._lateness = patience, lateness
        self._missing = {name: _Missing(lateness) for name in sources}

    def look(self, faults: Mapping[str, str]) -> list[Condition]:
        """What is wrong with the sources now.

        Args:
            faults: what keeps a source from going on, in words.

        Raises:
            InputError: the inbox cannot be read.
        """
        now = self._clock.now()
        found = [
            Condition(self._key("fault", name), f"source {name}: {faults[name]}", now)
            for name in self._sources
            if name in faults
        ]
        for name in self._sources:
            silence = self._twin.silence(name)
            if silence >= self._patience:
                words = f"source {name} has sent nothing for {in_words(self._patience)}"
                since = now - timedelta(seconds=silence)
                found.append(Condition(self._key("down", name), words, since))
            missing = self._missing[name].look(self._twin.numbers(name), self._clock.monotonic())
            if missing:
                words = f"source {name}: {counted(missing, 'packet')} never came"
                found.append(Condition(self._key("missing", name), words, now, size=missing))
            if self._twin.counts_again(name):
                words = f"source {name}: a logger counts anew under a stream that it had before"
                words += ": its packets are refused"
                found.append(Condition(self._key("numbers", name), words, now))
            clock = self._twin.clock_fault(name)
            if clock is not None:
                found.append(Condition(self._key("clock", name), f"source {name}: {clock}", now))
            remarks = self._twin.remarks(name)
            for cause, told in (("refused", remarks.refused), ("doubted", remarks.doubted)):
                if told:
                    key = self._key(cause, name)._replace(kind="quality")
                    words = f"source {name}: {_remarked(cause, dict(told))}"
                    found.append(Condition(key, words, now, size=len(told)))
        return found

    def _key(self, cause: str, source: str) -> ConditionKey:
        return ConditionKey(self._twin.name, "source", cause, source)


def _remarked(cause: str, told: Mapping[str, str]) -> str:
    """Channels that are not used, or are doubtful, and why.

    >>> _remarked("refused", {"D7": "the model has no such channel"})
    '1 channel is not used: D7 (the model has no such channel)'
    """
    listed = [f"{name} ({why})" for name, why in [*told.items()][:MOST_NAMED]]
    if len(told) > MOST_NAMED:
        listed.append("...")
    are = "is" if len(told) == 1 else "are"
    what = "not used" if cause == "refused" else "doubtful"
    return in_a_line(f"{counted(len(told), 'channel')} {are} {what}: {', '.join(listed)}")


class _Missing:
    """Which packets of a source are missing for longer than others may overtake them.

    Args:
        lateness: for which they may [s].
    """

    def __init__(self, lateness: float) -> None:
        self._lateness = lateness
        self._marked: float | None = None
        #: number after the highest of each stream, at the last mark and at the one before
        self._last: dict[str, int] = {}
        self._before: dict[str, int] = {}

    def look(self, numbers: Mapping[str, Numbers], now: float) -> int:
        """How many are, at a time by the monotonic clock [s]."""
        highest = {stream: known.next for stream, known in numbers.items()}
        if self._marked is None:
            self._marked, self._last, self._before = now, highest, highest
        elif now - self._marked >= self._lateness:
            self._marked, self._last, self._before = now, highest, self._last
        return sum(
            max(0, min(last + 1, self._before.get(stream, 0)) - first)
            for stream, known in numbers.items()
            for first, last in known.gaps
            # A logger that runs already, or counts from 1, has not sent what comes before.
            if first > 0
        )
