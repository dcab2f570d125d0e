"""Loads that stand on a structure with their mass while it swings, such as a parked truck."""

from collections.abc import Mapping
from typing import TypeVar

from rga.model.effect import Effect
from rga.model.schema import Model

Known = TypeVar("Known")


def brings_mass(effect: Effect) -> bool:
    """Whether an effect is a load whose mass swings with the structure."""
    return effect.swinging() not in (None, effect)


def stands_late(effect: Effect) -> bool:
    """Whether an effect brings a mass that stands there in some windows only."""
    return effect.onset is not None and brings_mass(effect)


def without_standing(model: Model) -> Model:
    """The model without the loads that bring their mass; itself where it has none."""
    if not any(map(brings_mass, model.effects.values())):
        return model
    kept = {name: one for name, one in model.effects.items() if not brings_mass(one)}
    return model.model_copy(update={"effects": kept})


def weather(model: Model, contexts: Mapping[str, Known]) -> dict[str, Known]:
    """Contexts that may move modes beside what the model says of them.

    One that says nothing but where a load of known mass stands, and how much of it, moves them by
    that mass alone.
    """
    moving: set[str] = set()
    others: set[str] = set()
    for effect in model.effects.values():
        if brings_mass(effect):
            moving |= effect.drivers()
        elif not effect.is_load:
            others |= effect.drivers()
    return {name: known for name, known in contexts.items() if name not in moving - others}
