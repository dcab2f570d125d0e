"""Whether it is known of every packet of a twin what became of it."""

from rga.operation.alarms.condition import Condition, ConditionKey
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock
from rga.quantities import counted

#: how often the account is looked at, which is as long as the twin is old [s]
EVERY = 600.0


class AccountWatch:
    """Looks at the account of the packets of a twin.

    Args:
        twin: that they belong to.
        clock: of the service.
    """

    def __init__(self, twin: ServedTwin, clock: ServiceClock) -> None:
        self._twin, self._clock = twin, clock
        self._looked: float | None = None
        self._found: list[Condition] = []

    def look(self) -> list[Condition]:
        """What is wrong with the account, as it was found EVERY ago at the most.

        Raises:
            InputError: the inbox cannot be read.
        """
        now = self._clock.monotonic()
        if self._looked is None or now - self._looked >= EVERY:
            self._found, self._looked = self._wrong(), now
        return self._found

    def _wrong(self) -> list[Condition]:
        unknown: dict[str, int] = {}
        for (source, _), one in self._twin.packets.account().items():
            # What is missing of one hour is not made up for by what is too much of another.
            unknown[source] = unknown.get(source, 0) + abs(one.difference)
        return [
            Condition(
                ConditionKey(self._twin.name, "service", "account", source),
                f"source {source}: of {counted(count, 'packet')} nothing is known: a fault of rga",
                self._clock.now(),
                size=count,
            )
            for source, count in unknown.items()
            if count
        ]
