"""The arrays behind a diagnosis by modes: what its report draws."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rga.arrays import FloatArray
from rga.model.schema import Model


@dataclass(frozen=True)
class ModeReading:
    """One mode, as measured and as simulated before and after.

    Attributes:
        name: of the mode.
        frequency: median of the windows [Hz].
        scatter: of a window, as a share of the frequency.
        found: share of the windows in which it was found.
        points: at which its shape was measured.
        shape: there, of length one, float[points].
        log_f: measured, float[windows] [ln Hz]; NaN where it was not found.
        before, after: simulated, float[windows] [ln Hz].
        mac: of the measured shape with the simulated ones, before and after; NaN without shape.
        number: of the computed mode that it is, from one on, before and after.
        shapes: of all nodes, before and after, float[nodes, 3] each.
    """

    name: str
    frequency: float
    scatter: float
    found: float
    points: Sequence[str]
    shape: FloatArray
    log_f: FloatArray
    before: FloatArray
    after: FloatArray
    mac: tuple[float, float]
    number: tuple[int, int]
    shapes: tuple[FloatArray, FloatArray]


@dataclass(frozen=True)
class ModalArrays:
    """What was measured of modes, and what was simulated.

    Attributes:
        model: as it was given.
        extended: with the causes that were found.
        modes: those that were found in the record.
        time: of the windows [s], float[windows].
        weather: contexts that may move modes beside what the model says, float[windows] each.
    """

    model: Model
    extended: Model
    modes: Sequence[ModeReading]
    time: FloatArray
    weather: Mapping[str, FloatArray]
