"""Windows in which the same effects act."""

from collections.abc import Iterator, Mapping

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.modal.points.recorded import changes_shapes
from rga.model.effect import Effect, blend
from rga.model.parameter import Estimated


def of_windows(effect: Effect) -> bool:
    """Whether an effect of the model acts in some windows only, or on what is recorded."""
    late = effect.onset is not None and effect.swinging() is effect
    return late or effect.overrides("frequency_factor") or changes_shapes(effect)


def stages(
    effects: Mapping[str, Effect], time: FloatArray
) -> Iterator[tuple[BoolArray, list[Effect]]]:
    """Windows, bool[windows], with the effects that act in them, each as it acts there.

    Args:
        effects: by name.
        time: of the windows on the scale of onsets [s], float[windows].
    """
    late = [one for one in effects.values() if one.onset is not None]
    weights = np.array([one.weight(time) for one in late]).reshape(len(late), len(time))
    parts, of_window = np.unique(weights, axis=1, return_inverse=True)
    of_window = np.asarray(of_window).ravel()
    for number, acting in enumerate(parts.T):
        some = iter(acting)
        now = [
            one if one.onset is None else _partly(one, float(next(some)))
            for one in effects.values()
        ]
        yield of_window == number, [one for one in now if one is not None]


def _partly(effect: Effect, weight: float) -> Effect | None:
    """An effect that acts as it does with a share of it; None where it does not yet."""
    if weight <= 0.0:
        return None
    always = effect.model_copy(update={"onset": None, "profile": "step", "end": None})
    if weight >= 1.0:
        return always
    values = {}
    for name, parameter in effect.parameters().items():
        own = getattr(effect, name)
        own = own.value if isinstance(own, Estimated) else own
        if parameter.neutral is not None and isinstance(own, float):
            values[name] = float(blend(np.array([own]), parameter.neutral, np.array([weight]))[0])
    return always.with_values(values)
