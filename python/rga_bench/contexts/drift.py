"""What comes partway into a stream."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga_bench.contexts.context_regime import Contexts
from rga_bench.synthetic.physical_twin import PhysicalTwin

#: what there is; nothing comes with the first, the null twin of all others
DRIFTS = ("none", "sensor", "operational", "structural", "novel", "recurring")
#: share of a stream before anything comes
BEFORE = 0.4
#: one sensor in so many is affected
ONE_IN = 10
#: offsets of sensors [standard deviations of their noise], and deviations of their gain [-]
OFFSETS, GAIN = (5.0, 15.0), 0.1


@dataclass(frozen=True)
class MeasuredRows:
    """Measured rows with what nobody knows of them.

    Attributes:
        contexts: float[n, contexts].
        readings: in the units of the sensors, float[n, sensors].
        noise: that is in them, of the same shape.
    """

    contexts: FloatArray
    readings: FloatArray
    noise: FloatArray


@dataclass(frozen=True)
class MeasurementConditions:
    """What rows are measured under.

    Attributes:
        twin: the structure.
        contexts: that it is under.
        gain: of each sensor, float[sensors].
        offset: of each sensor, in its unit, float[sensors].
    """

    twin: PhysicalTwin
    contexts: Contexts
    gain: FloatArray
    offset: FloatArray

    @classmethod
    def usual(cls, twin: PhysicalTwin, contexts: Contexts, sensors: int) -> "MeasurementConditions":
        """With sound sensors."""
        return cls(twin, contexts, np.ones(sensors), np.zeros(sensors))

    def measured(self, rows: int, generator: np.random.Generator) -> MeasuredRows:
        """Consecutive rows."""
        return following(self, self, np.zeros(rows, dtype=bool), generator)

    def drifted(
        self, drift: str, noise: FloatArray, generator: np.random.Generator
    ) -> "MeasurementConditions":
        """What a drift makes of them.

        `sensor` gives some sensors an offset and another gain; `operational` moves contexts to
        where they never were; `structural` damages the structure; `novel` moves contexts beyond
        their ranges; `recurring` is operational and in the sensors.

        Args:
            drift: one of `DRIFTS`.
            noise: standard deviation of each sensor's, float[sensors].
            generator: of what is random.

        Raises:
            InputError: no such drift.
        """
        if drift not in DRIFTS:
            known = ", ".join(DRIFTS)
            raise InputError(f"there is no drift {drift!r}", "drifts", f"give one of {known}")
        changed = self
        if drift in ("sensor", "recurring"):
            sensors = len(noise)
            hit = generator.choice(sensors, -(-sensors // ONE_IN), replace=False)
            gain, offset = self.gain.copy(), self.offset.copy()
            gain[hit] *= generator.uniform(1.0 - GAIN, 1.0 + GAIN, len(hit))
            size = generator.uniform(*OFFSETS, len(hit)) * generator.choice([-1.0, 1.0], len(hit))
            offset[hit] += size * noise[hit]
            changed = replace(changed, gain=gain, offset=offset)
        if drift in ("operational", "recurring"):
            changed = replace(changed, contexts=replace(self.contexts, manner="elsewhere"))
        if drift == "novel":
            changed = replace(changed, contexts=replace(self.contexts, manner="beyond"))
        if drift == "structural":
            changed = replace(changed, twin=self.twin.damaged(int(generator.integers(2**31))))
        return changed


def when(drift: str, rows: int) -> NDArray[np.bool_]:
    """Which rows of a stream a drift holds, bool[rows]; `recurring` has every other quarter."""
    row = np.arange(rows)
    if drift == "none":
        return np.zeros(rows, dtype=bool)
    if drift == "recurring":
        return np.asarray(row * 4 // rows % 2 == 1)
    return np.asarray(row >= BEFORE * rows)


def following(
    usual: MeasurementConditions,
    drifted: MeasurementConditions,
    when: NDArray[np.bool_],
    generator: np.random.Generator,
) -> MeasuredRows:
    """Consecutive rows, some of them under other conditions."""
    rows = len(when)
    before, behind = (one.contexts.draw(rows, generator) for one in (usual, drifted))
    contexts = np.where(when[:, None], behind, before)
    noise = usual.twin.noise(generator, rows)
    readings = noise.copy()
    for conditions, chosen in ((usual, ~when), (drifted, when)):
        if chosen.any():
            shown = conditions.gain * conditions.twin.read(contexts[chosen]) + conditions.offset
            readings[chosen] += shown
    return MeasuredRows(contexts, readings, noise)
