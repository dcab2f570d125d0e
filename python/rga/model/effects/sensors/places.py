"""Sensors as places of effects."""

from collections.abc import Iterator
from typing import Annotated, Any

from rga.model.parameter import Place
from rga.model.schema import Model

Sensors = Annotated[str | list[str], Place("sensor")]


def each_sensor(model: Model) -> Iterator[dict[str, Any]]:
    """Every sensor as a place."""
    yield from ({"sensor": sensor} for sensor in model.sensors)
