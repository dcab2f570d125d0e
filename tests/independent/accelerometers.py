"""What accelerometers that are not right make of measured shapes, by plain NumPy."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from independent.modal_bridge import SHAPE_NOISE
from rga.records.modal.record import ModalRecord


def scaled(record: ModalRecord, factors: Mapping[str, float]) -> ModalRecord:
    """Shapes of which points are off by a factor: -1 where one is turned, 0 where it shows zero."""
    shapes = record.shapes.copy()
    for point, factor in factors.items():
        shapes[:, record.points.index(point)] *= factor
    return replace(record, shapes=shapes)


def exchanged(record: ModalRecord, one: str, other: str) -> ModalRecord:
    """The channels of two points in each other's place."""
    shapes = record.shapes.copy()
    columns = [record.points.index(one), record.points.index(other)]
    shapes[:, columns] = record.shapes[:, columns[::-1]]
    return replace(record, shapes=shapes)


def noise_alone(record: ModalRecord, point: str, seed: int) -> ModalRecord:
    """A point that shows what noise makes of nothing."""
    shapes = record.shapes.copy()
    column = SHAPE_NOISE * np.random.default_rng(seed).standard_normal(len(shapes))
    shapes[:, record.points.index(point)] = column
    return replace(record, shapes=shapes)


def at_some(record: ModalRecord, points: tuple[str, ...]) -> ModalRecord:
    """The record of fewer accelerometers."""
    columns = [record.points.index(point) for point in points]
    return replace(record, points=points, shapes=record.shapes[:, columns])
