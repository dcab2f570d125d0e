"""The sensors of a twin as a table says them."""

from collections.abc import Iterable
from dataclasses import dataclass

from rga.dashboard.svg.gap_level import OUT_OF_USE, UNKNOWN, GapLevel, gap_level
from rga.model.schema import Model
from rga.operation.reading.twin_now import SensorNow, TwinNow
from rga.quantities import DASH, counted, number, scale, short


@dataclass(frozen=True)
class SensorRow:
    """A sensor of the table, and of the drawing.

    Attributes:
        number: in the model, from 0.
        name, kind, unit: of it.
        place: where it sits, in words.
        measured, simulated, difference, noise: of the last row, in its unit.
        gap, level: over the last rows.
        recent: the gap as a number [-]; None: it is not known, or the sensor is out of use.
        words: all this in a line.
    """

    number: int
    name: str
    kind: str
    unit: str
    place: str
    measured: str
    simulated: str
    difference: str
    noise: str
    gap: str
    level: GapLevel
    recent: float | None
    words: str


def sensor_rows(model: Model, now: TwinNow) -> list[SensorRow]:
    """The sensors of a twin in the order of its model."""
    return [
        _row(place, name, model, now.sensors[name], name not in now.out_of_use)
        for place, name in enumerate(model.sensors)
        if name in now.sensors
    ]


def farthest_first(rows: Iterable[SensorRow]) -> list[SensorRow]:
    """Sensors by their gap, the largest first; those of which none is known come last."""
    return sorted(rows, key=lambda one: (one.recent is None, -(one.recent or 0.0), one.number))


def place_words(model: Model, name: str) -> str:
    """Where a sensor sits."""
    sensor = model.sensors[name]
    return f"on member {sensor.member}" if sensor.member is not None else f"at node {sensor.node}"


def out_of_use_words(now: TwinNow) -> str:
    """How many sensors are not watched, in words; nothing where all are."""
    out = len(now.out_of_use)
    if not out:
        return ""
    are = "is" if out == 1 else "are"
    return f"{out} of {counted(len(now.sensors), 'sensor')} {are} out of use"


def _row(place: int, name: str, model: Model, one: SensorNow, is_used: bool) -> SensorRow:
    sensor = model.sensors[name]
    # All values of a sensor are said in the unit that suits the largest of them.
    largest = max(abs(one.measured or 0.0), abs(one.simulated or 0.0))
    factor, unit = scale(sensor.unit, largest)
    apart = None
    if one.measured is not None and one.simulated is not None:
        apart = one.measured - one.simulated
    measured, simulated, difference, noise = (
        DASH if value is None else short(value * factor)
        for value in (one.measured, one.simulated, apart, one.noise)
    )
    level = gap_level(one.recent) if is_used else OUT_OF_USE
    recent = None if level in (UNKNOWN, OUT_OF_USE) else one.recent
    gap = DASH if recent is None else number(recent, 2)
    words = (
        f"{name}, {sensor.kind} {place_words(model, name)}: measured {measured}, simulated "
        f"{simulated} {unit}, noise {noise}; {level.words}, gap {gap}"
    )
    return SensorRow(
        place, name, sensor.kind, unit, place_words(model, name), measured, simulated, difference,
        noise, gap, level, recent, words,
    )  # fmt: skip
