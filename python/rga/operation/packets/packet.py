"""A packet: what a logger sends at once."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from hashlib import sha256

import numpy as np
import numpy.typing as npt

from rga.arrays import FloatArray

#: bytes of a packet, and its longest time [s]
MOST_BYTES, LONGEST = 8 * 2**20, 60.0
#: channels of a packet
MOST_CHANNELS = 5_000
#: microseconds in a second
MICROSECONDS = 1_000_000
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)

Moments = npt.NDArray[np.int64]


@dataclass(frozen=True, order=True)
class Number:
    """By which a packet is known from all others of its source.

    Attributes:
        stream: drawn by the logger when it starts.
        sequence: of the packet within the stream, counted from 0.
    """

    stream: str
    sequence: int


@dataclass(frozen=True)
class SensorPacket:
    """Readings of some channels.

    Attributes:
        number: None: the logger counts none, and nobody can tell whether one was lost.
        channels: as the logger calls them.
        times: int64[n], microseconds since 1970 (UTC), rising.
        values: float64[n, channels], as the logger has them, NaN where one is missing.
        units: by channel, where the logger states them.
        timed: False: it has no times of its own, and is of when it arrived.
    """

    number: Number | None
    channels: tuple[str, ...]
    times: Moments
    values: FloatArray
    units: Mapping[str, str] = field(default_factory=dict)
    timed: bool = True

    @property
    def sha256(self) -> str:
        """Of what it says, however it was written.

        >>> from dataclasses import replace
        >>> times, values = np.array([0]), np.array([[0.5, np.nan]])
        >>> one = SensorPacket(None, ("D1", "D2"), times, values)
        >>> other = SensorPacket(None, ("D2", "D1"), times, values[:, ::-1])
        >>> one.sha256 == other.sha256, one.sha256 == replace(one, values=values + 1).sha256
        (True, False)
        """
        order = sorted(range(len(self.channels)), key=self.channels.__getitem__)
        said = json.dumps([[self.channels[k] for k in order], self.times.tolist()])
        # All that is missing is missing alike, and a zero has no sign.
        values = np.where(np.isnan(self.values), np.nan, self.values + 0.0)[:, order]
        return sha256(said.encode() + values.tobytes()).hexdigest()
