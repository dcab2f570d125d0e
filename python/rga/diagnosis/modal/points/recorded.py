"""What sensors at points make of mode shapes: a turned one, two that are exchanged, a dead one."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Effect, Values
from rga.model.effects.sensors.sensor_fault import SensorFault
from rga.model.readings import Readings
from rga.model.schema import Model
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.expected import Expected


def changes_shapes(effect: Effect) -> bool:
    """Whether an effect changes what points show of shapes; one that is dead shows nothing."""
    return bool(effect.points_named()) and not isinstance(effect, SensorFault)


def as_recorded(
    shapes: Sequence[FloatArray],
    effects: Sequence[Effect],
    points: Iterable[str],
    contexts: Values,
) -> list[FloatArray]:
    """Shapes under several contexts as sensors at points record them.

    Args:
        shapes: true motion under each, float[modes, points].
        effects: that act at points, all the time.
        points: their names.
        contexts: float[contexts] each.
    """
    found = [one.copy() for one in shapes]
    columns = {name: column for column, name in enumerate(points)}
    for effect in effects:
        values = effect.values(contexts, len(found))
        for row, shown in enumerate(found):
            # To a sensor the modes are as rows of a record.
            count = len(shown)
            own = {name: np.full(count, column[row]) for name, column in values.items()}
            still = np.zeros(count)
            effect.change_readings(Readings(shown, {}, still, still, {"": columns}), own)
    return found


def looks_as_recorded(
    expected: Mapping[str, Expected], effects: Iterable[Effect], model: Model
) -> dict[str, Expected]:
    """What modes look like to the sensors at points, by what acts on these all the time.

    Args:
        expected: true looks, by name of the mode.
        effects: of which some may act at points.
        model: with these points.
    """
    always = [one for one in effects if changes_shapes(one) and one.onset is None]
    if not always:
        return dict(expected)
    true = np.full((len(expected), len(model.points)), np.nan)
    for shape, look in zip(true, expected.values(), strict=True):
        shape[look.at] = look.shape
    middle = {name: np.array([sum(one.range) / 2]) for name, one in model.context.items()}
    (shown,) = as_recorded([true], always, model.points, {**middle, "time": np.zeros(1)})
    return {
        name: replace(look, at=np.flatnonzero(np.isfinite(shape)), shape=shape[np.isfinite(shape)])
        for (name, look), shape in zip(expected.items(), shown, strict=True)
    }


def without_dead_points(record: ModalRecord, model: Model) -> ModalRecord:
    """The record without what it holds of points that the model says do not work."""
    shapes = record.shapes.copy()
    for effect in model.effects.values():
        if isinstance(effect, SensorFault):
            since = effect.weight(record.origin + record.time) > 0
            dead = np.isin(record.points, effect.points_named())
            shapes[np.ix_(since, dead)] = np.nan
    return replace(record, shapes=shapes)
