"""The ways in which a channel of a logger breaks.

Each is a pure function of a column, a generator of random numbers, and the scale of the channel.
Sizes are those at which an engineer calls the channel broken: 5 to 50 times its noise and at
least a fifth of what it moves over, whichever is more.

Sources, by the letters that the faults give:

- N: Ni et al., Sensor network data fault types, ACM Trans. Sensor Networks 5(3), 2009.
- B: Bao et al., Computer vision and deep learning based data anomaly detection, Structural
  Health Monitoring 18(2), 2019: what six years of a cable-stayed bridge's channels showed.
- K: Kullaa, Detection, identification, and quantification of sensor fault in a sensor network,
  Mechanical Systems and Signal Processing 40(1), 2013.
- H: Keil, Technology and Practical Use of Strain Gages, Ernst & Sohn, 2017: bonds, bridges,
  amplifiers and cables of strain gauges.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.model.units import per_si

Array = NDArray[np.float64]

#: bounds of a fault's size in the channel's noise, and in what the channel moves over
IN_NOISE, IN_SPAN = (5.0, 50.0), (0.2, 1.0)
#: full scale of a quarter bridge's amplifier, 8 mV/V at a gauge factor of 2 [-]
AMPLIFIER = 0.016
#: full scale of another transducer, in what the channel moves over
TRANSDUCER = 20.0
#: what a channel is taken to move over at least, in its noise: one at rest moves over nothing
_AT_REST = 5.0


@dataclass(frozen=True)
class Scale:
    """Sizes of a channel, in its unit.

    Attributes:
        noise: standard deviation of its noise.
        span: what it moves over while sound.
        full: full scale of its amplifier or transducer, to either side.
    """

    noise: float
    span: float
    full: float

    @classmethod
    def of(cls, sensor: Mapping[str, Any], column: Array) -> Scale:
        """That of a sensor as a model file has it, with its sound column [rows]."""
        known = column[np.isfinite(column)]
        steps = np.diff(known)
        # Steps between rows, where the file does not say: white noise changes by sqrt(2) of its
        # standard deviation, and the median of what is normal is 0.6745 of that.
        seen = float(np.median(np.abs(steps))) / (0.6745 * np.sqrt(2.0)) if len(steps) else 0.0
        noise = float(sensor.get("noise") or seen or 1.0)
        low, high = np.quantile(known, (0.02, 0.98)) if len(known) else (0.0, 0.0)
        span = max(float(high - low), _AT_REST * noise)
        if sensor["kind"] != "strain":
            return cls(noise, span, TRANSDUCER * span)
        return cls(noise, span, AMPLIFIER * per_si("strain", sensor["unit"], "a gauge"))

    def size(self, rng: np.random.Generator) -> float:
        """A drawn size of a fault."""
        noises = float(np.exp(rng.uniform(*np.log(IN_NOISE))))
        return max(noises * self.noise, float(rng.uniform(*IN_SPAN)) * self.span)


#: column [rows] without gaps, generator, scale, another channel's column [rows] -> column [rows]
Change = Callable[[Array, np.random.Generator, Scale, Array], Array]


@dataclass(frozen=True)
class ChannelFault:
    """One way in which a channel breaks.

    Attributes:
        name: of the fault.
        happens: what happens physically, in one sentence.
        source: letters of the sources above.
        change: the column as the logger gives it then.
    """

    name: str
    happens: str
    source: str
    change: Change

    def spoil(
        self,
        column: Array,
        rng: np.random.Generator,
        scale: Scale,
        other: Array,
        onset: int = 0,
    ) -> Array:
        """The column with the fault from row `onset` on.

        Args:
            column: the sound channel [rows], NaN where missing, and so it stays.
            rng: same state, same bits.
            scale: of the channel.
            other: the column of another channel [rows], of which a copy is made.
            onset: first row of the fault.

        Returns:
            A new column [rows].
        """
        out = column.copy()
        late = column[onset:]
        has = np.isfinite(late)
        if has.any():
            changed = self.change(_filled(late), rng, scale, _filled(other[onset:]))
            out[onset:] = np.where(has, changed, np.nan)
        return out


def _filled(column: Array) -> Array:
    """A column whose gaps are bridged by straight lines; zeros where there is nothing."""
    has = np.isfinite(column)
    if has.all() or not has.any():
        return np.where(has, column, 0.0)
    rows = np.arange(len(column))
    return np.asarray(np.interp(rows, rows[has], column[has]))


def _noise(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    return column + scale.size(rng) * rng.standard_normal(len(column))


def _wander(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """A random walk whose expected distance from its beginning is the size at the last row."""
    step = scale.size(rng) / np.sqrt(len(column))
    return np.asarray(column + np.cumsum(step * rng.standard_normal(len(column))))


def _clipping(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """Between 30 % and 70 % of the rows lie beyond the end of the range."""
    share = rng.uniform(0.3, 0.7)
    if rng.random() < 0.5:
        return np.minimum(column, np.quantile(column, 1.0 - share))
    return np.maximum(column, np.quantile(column, share))


def _zeros(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """Bursts of 2 to 20 rows at zero, over 10 % to 40 % of the rows."""
    return np.where(_bursts(len(column), rng, (2, 20), (0.1, 0.4)), 0.0, column)


def _jumps(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """Two to five jumps of the zero to either side, and each stays."""
    many = int(rng.integers(2, 6))
    rows = rng.integers(0, len(column), many)
    sizes = scale.size(rng) * rng.uniform(0.5, 1.5, many) * rng.choice([-1.0, 1.0], many)
    return np.asarray(column + (sizes * (np.arange(len(column))[:, None] >= rows)).sum(axis=1))


def _sign(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    return -column


def _thousandfold(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    return 1000.0 * column


def _copy(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    return other.copy()


def _contact(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """5 % to 30 % of the rows, one by one, at one end of the amplifier's range."""
    rail = scale.full * rng.choice([-1.0, 1.0])
    return np.where(rng.random(len(column)) < rng.uniform(0.05, 0.3), rail, column)


def _mains(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """A sine of constant amplitude, of 3 to 40 rows a period: 50 Hz that sampling has folded."""
    period = float(np.exp(rng.uniform(np.log(3.0), np.log(40.0))))
    turn = 2.0 * np.pi * (np.arange(len(column)) / period + rng.random())
    return column + scale.size(rng) * np.sin(turn)


def _creep(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """Towards its end as 1 - exp(-t / tau), tau 20 % to 60 % of the rows."""
    tau = rng.uniform(0.2, 0.6) * len(column)
    grown = 1.0 - np.exp(-np.arange(len(column)) / tau)
    return np.asarray(column + scale.size(rng) * rng.choice([-1.0, 1.0]) * grown)


def _stuck(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    return np.full_like(column, column[0])


def _late(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """By 3 rows up to an eighth of them; before the first row it read what it read there."""
    most = max(4.0, len(column) / 8.0)
    rows = int(np.exp(rng.uniform(np.log(3.0), np.log(most))))
    return column[np.maximum(np.arange(len(column)) - rows, 0)]


def _one_bit(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """Two or three levels over what the channel moves over."""
    step = scale.span / float(rng.integers(1, 3))
    least = float(np.quantile(column, 0.02))
    return least + step * np.round((column - least) / step)


def _spikes(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """2 % to 8 % of the rows, alone, off by 1 to 10 times the size to either side."""
    hit = rng.random(len(column)) < rng.uniform(0.02, 0.08)
    hit[int(rng.integers(len(column)))] = True
    off = scale.size(rng) * rng.uniform(1.0, 10.0, len(column))
    return np.where(hit, column + off * rng.choice([-1.0, 1.0], len(column)), column)


def _dead(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    return scale.noise * rng.standard_normal(len(column))


def _swings(column: Array, rng: np.random.Generator, scale: Scale, other: Array) -> Array:
    """A quick walk between -0.9 and +1.1 of full scale, where it saturates.

    A gauge on a girder of a railway read from -14 000 to +17 500 microstrain in one crossing.
    """
    step = scale.full * np.exp(rng.uniform(np.log(0.1), np.log(1.0)))
    walk = np.cumsum(step * rng.standard_normal(len(column)))
    return np.asarray(column + np.clip(walk, -0.9 * scale.full, 1.1 * scale.full))


def _bursts(
    rows: int, rng: np.random.Generator, length: tuple[int, int], share: tuple[float, float]
) -> NDArray[np.bool_]:
    """Rows that lie in bursts, over at least a drawn share of them."""
    hit = np.zeros(rows, dtype=bool)
    wanted = rng.uniform(*share) * rows
    while hit.sum() < wanted:
        first = int(rng.integers(rows))
        hit[first : first + int(rng.integers(length[0], length[1] + 1))] = True
    return hit


FAULTS: dict[str, ChannelFault] = {
    one.name: one
    for one in (
        ChannelFault(
            "noise",
            "A loose wire at a bridge amplifier adds white noise many times the channel's.",
            "N K",
            _noise,
        ),
        ChannelFault(
            "wander",
            "Moisture under the cover lowers the insulation, and the zero walks at random.",
            "B H",
            _wander,
        ),
        ChannelFault(
            "clipping",
            "The readings leave the range that the amplifier was set to, and stay at its end.",
            "N",
            _clipping,
        ),
        ChannelFault(
            "zeros",
            "Telegrams of a bus or a radio are lost, and the logger writes zeros instead.",
            "N B",
            _zeros,
        ),
        ChannelFault(
            "jumps",
            "Plugs, restarts and knocks move the zero several times to another value.",
            "B K",
            _jumps,
        ),
        ChannelFault(
            "sign", "Two wires of the bridge are exchanged: the sign is turned.", "H", _sign
        ),
        ChannelFault(
            "thousandfold",
            "The channel is set to another unit, and reads a thousand times as much.",
            "N",
            _thousandfold,
        ),
        ChannelFault(
            "copy",
            "The logger maps two names to one input: the channel copies another.",
            "N",
            _copy,
        ),
        ChannelFault(
            "bad contact",
            "A contact opens from time to time, and the amplifier goes to the end of its range.",
            "B H",
            _contact,
        ),
        ChannelFault(
            "mains",
            "A cable without a screen picks 50 Hz up, which sampling folds to a slow sine.",
            "H",
            _mains,
        ),
        ChannelFault(
            "creep",
            "An adhesive that was not cured lets the gauge slip, quickly first and then slower.",
            "H K",
            _creep,
        ),
        ChannelFault(
            "stuck",
            "The converter or its driver hangs, and the last reading is repeated.",
            "N K",
            _stuck,
        ),
        ChannelFault(
            "late",
            "The clock of the channel's own logger is late by some rows.",
            "N",
            _late,
        ),
        ChannelFault(
            "one bit",
            "The converter is set to a range far too wide: one bit or two are left.",
            "B",
            _one_bit,
        ),
        ChannelFault(
            "spikes", "Sparks and switched motors nearby give lone spikes.", "N B", _spikes
        ),
        ChannelFault(
            "dead",
            "The cable is cut: there is nothing but the amplifier's noise about zero.",
            "N K",
            _dead,
        ),
        ChannelFault(
            "swings",
            "A gauge whose wire is about to break swings over the whole range and saturates.",
            "B H",
            _swings,
        ),
    )
}
