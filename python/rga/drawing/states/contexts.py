"""The contexts at which a drawing shows loads, displacements and forces."""

from collections.abc import Mapping

from rga.model.schema import Model
from rga.quantities import PRETTY, short
from rga.simulation.whatif import check_settings


def settled(model: Model, given: Mapping[str, float] | None) -> dict[str, float]:
    """Contexts of one row: those given, the others at mid-range.

    Raises:
        InputError: a context that the model does not have, or that is far from its range.
    """
    check_settings(model, given or {})
    middle = {name: sum(variable.range) / 2 for name, variable in model.context.items()}
    return {**middle, **(given or {})}


def upper_ends(model: Model, given: Mapping[str, float] | None) -> dict[str, float]:
    """Contexts of one row: those given, the others at the upper ends of their ranges."""
    return {**{name: one.range[1] for name, one in model.context.items()}, **(given or {})}


def context_words(model: Model, contexts: Mapping[str, float], names: set[str]) -> str:
    """Contexts in words, those of `names` alone, in the order of the model."""
    said = []
    for name, variable in model.context.items():
        if name in names:
            unit = PRETTY.get(variable.unit, variable.unit)
            said.append(f"{name} = {short(contexts[name])} {'' if unit == '-' else unit}".strip())
    return ", ".join(said)
