"""Sensors, and points at which mode shapes are measured, as places of effects."""

from collections.abc import Iterator
from typing import Annotated, Any

from rga.model.effect import Effect
from rga.model.parameter import Place
from rga.model.schema import Model

Sensors = Annotated[str | list[str], Place("sensor")]
#: one of the two is given (`check_one_place`)
MaybeSensors = Annotated[str | list[str] | None, Place("sensor")]
MaybePoints = Annotated[str | list[str] | None, Place("point")]


def each_sensor(model: Model) -> Iterator[dict[str, Any]]:
    """Every sensor as a place."""
    yield from ({"sensor": sensor} for sensor in model.sensors)


def each_point(model: Model) -> Iterator[dict[str, Any]]:
    """Every point as a place."""
    yield from ({"point": point} for point in model.points)


def check_one_place(effect: Effect, sensor: str = "sensor", point: str = "point") -> None:
    """Refuse an effect that names both sensors and points, or neither (ValueError)."""
    if (getattr(effect, sensor) is None) == (getattr(effect, point) is None):
        raise ValueError(
            f"{effect.kind} acts on readings of sensors (give {sensor}) or on mode shapes where "
            f"they are measured (give {point}): give one of the two"
        )
