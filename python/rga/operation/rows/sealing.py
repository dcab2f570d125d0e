"""When a row is final, and making it of the samples that came for it."""

from collections.abc import Collection, Mapping, Sequence
from datetime import timedelta
from itertools import chain, groupby
from operator import attrgetter

import numpy as np

from rga.model import Model
from rga.operation.inbox.packets import KeptPacket, Packets
from rga.operation.packets.formats import PACKETS
from rga.operation.packets.packet import EPOCH
from rga.operation.rows.cells import SensorSamples, cell_of, cells_of
from rga.operation.rows.grid import Grid
from rga.operation.rows.samples import Reader
from rga.twin.hardware.inbox import Inbox
from rga.twin.hardware.interface import Station

#: bytes of payload that are read at a time
MOST_BYTES = 64 * 2**20
#: after any moment
EVER = 2**62
#: why a context is not used
LATE = "the first rows had none of it, and the twin infers it since; begin another to have it used"


class Sealing:
    """Makes rows of the packets of a twin as they become final.

    Args:
        inbox: of the twin.
        packets: in it.
        model: of the twin.
        readers: by source.
        grid: of the rows.
    """

    def __init__(
        self,
        inbox: Inbox,
        packets: Packets,
        model: Model,
        readers: Mapping[str, Reader],
        grid: Grid,
    ) -> None:
        self._inbox, self._packets, self._model = inbox, packets, model
        self._readers, self._grid = readers, grid

    def seal(self, latest: Mapping[str, int | None], silent: Collection[str]) -> int:
        """Give the twin all rows that are final.

        Args:
            latest: moment that each source has sent [µs since 1970]; None: it has sent nothing.
            silent: sources that nothing has been heard of for too long.

        Returns:
            How many rows are new.

        Raises:
            InputError: nothing can be written, or the twin has ended.
        """
        until = self._grid.final_until(latest, silent)
        if until is None:
            return 0
        rows = 0
        while (begin := self._packets.sealed) < until:
            kept, end = self._packets.between(begin, until, MOST_BYTES)
            if end < until:
                end = cell_of(end, self._grid.every)
                if end <= begin:
                    kept, end = self._packets.between(begin, begin + self._grid.every, EVER)
            rows += self._seal_with(kept, begin, end)
        return rows

    def _seal_with(self, kept: Sequence[KeptPacket], begin: int, end: int) -> int:
        samples = [_within(one, begin, end) for one in self._samples(kept)]
        samples = [one for one in samples if len(one.times)]
        if not samples:
            self._packets.seal(end, None, [])
            return 0
        station = self._inbox.station or self._station(samples)
        names = (*station.channels, *station.measured)
        cells = cells_of(samples, names, self._grid.every)
        self._packets.seal(end, station, cells)
        return len(cells)

    def _samples(self, kept: Sequence[KeptPacket]) -> list[SensorSamples]:
        """SensorSamples of packets, by source in the order of their names."""
        samples = []
        for source, reader in sorted(self._readers.items()):
            own = [one for one in kept if one.source == source]
            for late_before, some in groupby(own, key=attrgetter("late_before")):
                read = _read(reader, list(some))
                self._tell_late(reader, read)
                if late_before is not None:
                    read = [_within(one, late_before, EVER) for one in read]
                samples += read
        return samples

    def _tell_late(self, reader: Reader, samples: Sequence[SensorSamples]) -> None:
        """Tell of contexts that began to come after the first rows: the twin infers them."""
        station = self._inbox.station
        if station is not None:
            known = {*station.channels, *station.measured}
            for name in sorted({name for one in samples for name in one.names} - known):
                reader.remarks.refuse(name, LATE)

    def _station(self, samples: Sequence[SensorSamples]) -> Station:
        """What is mounted, as the configuration and the first rows show it."""
        sent = {name for one in samples for name in one.names}
        left_out = set.intersection(*(set(one.left_out) for one in self._readers.values()))
        channels = tuple(
            name for name in self._model.sensors if name in sent or name not in left_out
        )
        measured = tuple(name for name in self._model.context if name in sent)
        first = cell_of(min(int(one.times.min()) for one in samples), self._grid.every)
        start = (EPOCH + timedelta(microseconds=first)).isoformat()
        none = {name: np.zeros(0) for name in (*measured, "time")}
        return Station(channels, measured, start, "iso", none)


def _read(reader: Reader, kept: Sequence[KeptPacket]) -> list[SensorSamples]:
    """SensorSamples of packets of one source."""
    told = [(one.kind, one.payload, one.place, one.arrived) for one in kept]
    packets = [reader.packets_of(*one) for one in told if one[0] in PACKETS]
    samples = list(reader.of_packets(chain.from_iterable(packets)))
    return samples + [reader.of_rows(*one)[0] for one in told if one[0] not in PACKETS]


def _within(samples: SensorSamples, begin: int, end: int) -> SensorSamples:
    there = (samples.times >= begin) & (samples.times < end)
    return SensorSamples(samples.names, samples.times[there], samples.values[there])
