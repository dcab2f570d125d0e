"""What a run left behind, as arrays and events: what a report draws."""

from dataclasses import dataclass
from typing import Literal

from rga.arrays import FloatArray
from rga.model.schema import Model
from rga.records import Record

Kind = Literal[
    "calibration", "alarm", "recall", "recalibration", "novel context", "diagnosis", "version",
    "rollback", "proposal", "command",
]  # fmt: skip


@dataclass(frozen=True)
class Event:
    """Something that happened to the twin.

    Attributes:
        kind: what it was.
        row: row of the record at which it happened.
        time: the same as the record writes time: ISO 8601 text, or seconds.
        words: what happened, in a sentence.
        sensors: sensors that raised an alarm.
        gap_before, gap_after: mean squared residual over noise variance, on the rows that a
            recalibration or a new version was about [-].
    """

    kind: Kind
    row: int
    time: str | float
    words: str
    sensors: tuple[str, ...] = ()
    gap_before: float | None = None
    gap_after: float | None = None


@dataclass(frozen=True)
class Version:
    """A model version of the twin.

    Attributes:
        number: 1 for the model as it was given.
        row, time: from when on it was in force; time as the record writes it.
        causes: effects that it has beyond the model as given, in words.
        gain: held-out gain of the diagnosis that proposed it, with its 90 % interval [-].
        in_force: True for the version that the twin holds at the end.
    """

    number: int
    row: int
    time: str | float
    causes: tuple[str, ...]
    gain: float | None
    gain_ci90: tuple[float, float] | None
    in_force: bool


@dataclass(frozen=True)
class History:
    """A run of the twin.

    Attributes:
        model: as it was given.
        record: the rows so far.
        level: level of integration.
        calibration_rows: rows that the first calibration used.
        contexts: names of the contexts that were inferred.
        inferred: what the twin inferred at the time, float[rows, contexts] in their units, NaN
            where nothing was inferred.
        spread: posterior standard deviation of each, the same shape.
        simulated: what the twin simulated at the time, float[rows, sensors], NaN where it did not.
        gaps: squared differences of measured and simulated, float[rows, sensors] [unit squared];
            NaN where either is missing.
        noise: standard deviation of the noise of each sensor [its unit], float[sensors].
        events: in the order in which they happened.
        versions: model versions in their order.
        growth: (row, stored simulations, of these from novel contexts), whenever one changed.
    """

    model: Model
    record: Record
    level: Literal["A", "B", "C"]
    calibration_rows: int
    contexts: tuple[str, ...]
    inferred: FloatArray
    spread: FloatArray
    simulated: FloatArray
    gaps: FloatArray
    noise: FloatArray
    events: tuple[Event, ...]
    versions: tuple[Version, ...]
    growth: tuple[tuple[int, int, int], ...]
