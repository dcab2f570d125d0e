"""The simulation model: what the channels of a station would read at given contexts."""

import hashlib

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.inference.networks.design_samples import design
from rga.model import Model
from rga.simulation import Memory, Simulator
from rga.twin.calibration.correction import Correction
from rga.twin.hardware.interface import Station
from rga.twin.messages.queries import Q3, Q5, R3, R5, sha256


class SimulationModel:
    """What the channels of a station read.

    Args:
        model: a version of the twin's model.
        station: what is mounted on the structure.
        correction: of structure and sensors, by a calibration; None: there was none.

    Attributes:
        model: that version, with the channels of the station as its sensors, not corrected.
        latent: context variables that nothing measures.
        corrected: the model with its structure as it was found.
        simulator: of the corrected model.
        gains: factor of every channel on what the simulator says, float[channels].
        remembers: whether what it says of a row hangs on the rows before.
        carries: whether a memory of a fixed size stands for these.
        structure: tells its correction from others.
    """

    def __init__(
        self, model: Model, station: Station, correction: Correction | None = None
    ) -> None:
        self.model = mounted(model, station.channels)
        self.station = station
        self.latent = tuple(name for name in model.context if name not in station.measured)
        self.corrected, self.gains = self.model, np.ones(len(station.channels))
        self._offsets: FloatArray | None = None
        if correction is not None:
            self.corrected = correction.corrected(self.model)
            self.gains, self._offsets = correction.of_sensors(station.channels)
        self.simulator = Simulator(self.corrected)
        self._given = self.simulator if correction is None else Simulator(self.model)
        self.remembers = any(effect.remembers for effect in model.effects.values())
        self.carries = self.remembers and not self.simulator.hindrance
        self.structure = "" if correction is None else sha256_of(correction)

    def draw(self, query: Q3) -> R3:
        """Contexts drawn from a box, and what the channels read there."""
        box = dict(
            zip(self.model.context, zip(query.box.low, query.box.high, strict=True), strict=True)
        )
        drawn = design(
            self.corrected,
            query.rows,
            latent=self.latent,
            seed=query.seed,
            box={name: ends for name, ends in box.items() if ends[0] < ends[1]},
            time=query.clock,
        )
        offsets = self.offsets(np.full(1, query.clock), drawn.contexts[:1])
        readings = self.gains * drawn.readings + offsets
        return R3(
            row=query.row,
            version=query.version,
            origin=query.origin,
            contexts=drawn.contexts,
            readings=readings,
            falling=drawn.reversed,
            sha256=sha256(drawn.contexts, readings),
        )

    def follow(self, query: Q5) -> R5:
        """What the channels read at the contexts of rows of the record."""
        clock = np.concatenate([query.time_before, query.time])
        contexts = np.concatenate([query.contexts_before, query.contexts])
        readings, memory = self._followed(clock, contexts, query.memory)
        simulated = readings[len(query.time_before) :]
        if len(query.unknown):
            simulated[query.unknown] = np.nan
        last = dict(zip(self.model.context, query.contexts[-1].tolist(), strict=True))
        return R5(
            row=query.row,
            version=query.version,
            first=query.first,
            rows=query.rows,
            context=last,
            sha256=sha256(simulated),
            simulated=simulated,
            memory=memory,
        )

    def _followed(
        self, clock: FloatArray, contexts: FloatArray, memory: Memory | None
    ) -> tuple[FloatArray, Memory | None]:
        if not self.carries:
            return self.readings(clock, contexts), None
        table = dict(zip(self.model.context, contexts.T, strict=True))
        followed = self.simulator.follow({**table, "time": clock}, memory)
        shown = self.gains * followed.readings + self.offsets(clock, contexts)
        return np.asarray(shown), followed.memory

    def readings(self, clock: FloatArray, contexts: FloatArray) -> FloatArray:
        """What the channels read at contexts of rows that follow one another.

        Args:
            clock: of the rows [s], float[n].
            contexts: float[n, contexts].
        """
        table = dict(zip(self.model.context, contexts.T, strict=True))
        readings = self.simulator.predict({**table, "time": clock})
        return np.asarray(self.gains * readings + self.offsets(clock, contexts))

    def offsets(self, clock: FloatArray, contexts: FloatArray) -> FloatArray:
        """What the channels read beside their gains times what the simulator says.

        Args:
            clock, contexts: of rows at which the channels are read, float[n], float[n, contexts].

        Returns:
            float[channels].
        """
        return -self.zero(clock, contexts) if self._offsets is None else self._offsets

    def zero(self, clock: FloatArray, contexts: FloatArray) -> FloatArray:
        """Mean of the channels over the rows that the logger took for unloaded, float[channels].

        It is that of the model as given: what a calibration finds of the sensors is beside it.

        Args:
            clock, contexts: of rows at which the channels are read; latent lines are prolonged
                from them, float[n] and float[n, contexts].
        """
        zero_clock = self.station.zero["time"]
        if not len(zero_clock):
            return np.zeros(len(self.model.sensors))
        table = {"time": zero_clock}
        for column, (name, variable) in enumerate(self.model.context.items()):
            low, high = variable.range
            if name in self.station.zero:
                known = self.station.zero[name]
                table[name] = np.where(np.isfinite(known), known, (low + high) / 2)
            elif variable.law == "linear":
                # What has not arrived yet stands at the end of its range.
                span = clock[-1] - clock[0]
                rate = (contexts[-1, column] - contexts[0, column]) / span if span > 0 else 0.0
                ahead = contexts[0, column] + rate * (zero_clock - clock[0])
                table[name] = ahead if rate else np.full(len(zero_clock), low)
            else:
                table[name] = np.full(len(zero_clock), (low + high) / 2)
        return np.asarray(self._given.predict(table).mean(axis=0))


def sha256_of(correction: Correction) -> str:
    """What tells a correction from others."""
    return hashlib.sha256(correction.model_dump_json().encode()).hexdigest()


def mounted(model: Model, channels: tuple[str, ...]) -> Model:
    """The model with these sensors only, and without effects on others.

    Their zero is taken off by the station: it lies in rows that have long gone by.
    """
    return model.with_sensors({n: model.sensors[n] for n in channels}).without_zeros()


def broken(readings: FloatArray) -> NDArray[np.bool_]:
    """Channels that the model holds for faulty: it gives no reading for them, bool[channels]."""
    return np.asarray(np.isnan(readings).any(axis=0))
