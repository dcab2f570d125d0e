"""Rows wait a little for packets that later ones of their stream have overtaken."""

from collections.abc import Collection
from dataclasses import dataclass

from rga.operation.inbox.packets import Packets
from rga.operation.service_clock import ServiceClock

#: how long they are waited for [s]: a broker that hands out what it has kept lets new packets
#: overtake, and is done with it within seconds
LONGEST = 5.0


@dataclass(frozen=True)
class _Look:
    """What had come of a source at some time.

    Attributes:
        at: the time [s, monotonic].
        latest: moment that the source had sent [µs since 1970].
        next: of each stream, the number after the highest that had come.
    """

    at: float
    latest: int | None
    next: dict[str, int]


class Overtaken:
    """Knows the moment that each source has sent, as far as no new gap is in its numbers.

    A gap that was there before the service, or for longer than packets overtake each other, is a
    loss and holds nothing up; nor does what a stream sent before it was first heard.

    Args:
        packets: of a twin, before any of its sources is read.
        sources: their names.
        clock: of the service.
    """

    def __init__(self, packets: Packets, sources: Collection[str], clock: ServiceClock) -> None:
        self._packets, self._sources, self._clock = packets, list(sources), clock
        self._looks: dict[str, list[_Look]] = {name: [] for name in self._sources}
        self.latest()

    def latest(self) -> tuple[dict[str, int | None], bool]:
        """The moments [µs since 1970], and whether packets are waited for."""
        now, sent = self._clock.monotonic(), self._packets.latest()
        found: dict[str, int | None] = {}
        waits = False
        for source in self._sources:
            # Read after the moments: what comes in between is a gap that is seen too early.
            numbers = self._packets.numbers(source)
            looks = self._looks[source]
            while len(looks) > 1 and now - looks[1].at >= LONGEST:
                del looks[0]
            looks.append(
                _Look(now, sent[source], {name: one.next for name, one in numbers.items()})
            )
            before = looks[0].next
            new = {
                stream: first
                for stream, one in numbers.items()
                for first, _ in reversed(one.gaps)
                if first > 0 and first >= before.get(stream, 0)
            }
            waits = waits or bool(new)
            found[source] = next(
                look.latest
                for look in reversed(looks)
                if look is looks[0] or all(look.next.get(one, 0) <= new[one] for one in new)
            )
        return found, waits
