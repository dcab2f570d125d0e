"""Loads of a model as places of effects."""

from collections.abc import Iterator
from typing import Annotated, Any

from rga.model.effect import Effect
from rga.model.parameter import Place, listed
from rga.model.schema import Model

Effects = Annotated[str | list[str], Place("effect")]


def check_target(effect: Effect, named: str | list[str], model: Model, parameter: str) -> None:
    """Refuse an effect on others that lack the parameter that it changes (ValueError)."""
    for name in listed(named):
        kind = type(model.effects[name])
        if kind.loads is Effect.loads or parameter not in kind.parameters():
            raise ValueError(
                f"{effect.kind} acts on the {parameter} of a load, which {name!r} "
                f"({model.effects[name].kind}) has not: name a load with one"
            )


def load_names(model: Model) -> Iterator[str]:
    """Names of the loads of a model."""
    yield from (name for name, effect in model.effects.items() if effect.is_load)


def together(model: Model, names: list[str]) -> Iterator[dict[str, Any]]:
    """Loads that one context moves or scales count as one place; then each load, then all."""
    shared: dict[frozenset[str], list[str]] = {}
    for name in names:
        shared.setdefault(frozenset(model.effects[name].drivers()), []).append(name)
    for same in shared.values():
        yield {"effect": same[0] if len(same) == 1 else same}
        if len(same) > 1:
            yield from ({"effect": name} for name in same)
    if len(shared) > 1:
        yield {"effect": names}
