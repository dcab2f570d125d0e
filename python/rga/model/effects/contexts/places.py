"""Contexts as places of effects."""

from collections.abc import Iterator
from typing import Annotated, Any

from rga.model.parameter import Place
from rga.model.schema import Model

Contexts = Annotated[str | list[str], Place("context")]


def each_context(model: Model) -> Iterator[dict[str, Any]]:
    """Every context as a place."""
    yield from ({"context": context} for context in model.context)
