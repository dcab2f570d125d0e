"""Reasons why false alarms may come more often than they should."""

from collections.abc import Sequence

import numpy as np

from rga import _core
from rga.arrays import FloatArray
from rga.detection.baseline.baseline_model import Reference
from rga.detection.baseline.decorrelation import repeating
from rga.detection.baseline.stationarity import changed
from rga.detection.thresholds import MEMORIES, WITHIN, TailModel, memory_of

#: a baseline that chance makes so changeable less often is warned of
UNLIKELY = 0.01
#: part of a sensor's readings that may be one and the same
SAME = 0.6


def assumption_warnings(
    reference: Reference, baseline: FloatArray, simulated: TailModel, names: Sequence[str]
) -> tuple[str, ...]:
    """What speaks against the promise about false alarms, in words.

    Args:
        reference: that was learned from the baseline.
        baseline: float[rows, sensors], NaN where missing.
        simulated: what thresholds are made of.
        names: of the sensors.
    """
    found = []
    if memory_of(reference.weights) > MEMORIES[-1] + WITHIN:
        found.append(
            "the readings wander: they go with the ones before almost entirely, more than "
            "thresholds allow for; watch what they differ by from one row to the next"
        )
    if changed(reference, baseline, simulated) < UNLIKELY:
        found.append(
            "the baseline changes by itself more than its memory explains: false alarms will come "
            "more often; take a longer one, or one during which nothing changes"
        )
    same = [name for name, readings in zip(names, baseline.T, strict=True) if coarse(readings)]
    if same:
        found.append(
            f"{named(same)} mostly one value: with steps so coarse false alarms may come more often"
        )
    innovations = _core.innovations(baseline - reference.level, reference.weights)
    copies = [names[one] for one in repeating(reference.normal_scores(innovations))]
    if copies:
        found.append(
            f"{named(copies)} nearly what others of them read: false alarms will come more often; "
            "leave some of them out"
        )
    return tuple(found)


def coarse(readings: FloatArray) -> bool:
    """Whether most readings of a sensor, float[rows], are one and the same."""
    known = readings[np.isfinite(readings)]
    _, counts = np.unique(known, return_counts=True)
    return bool(counts.max(initial=0) > SAME * len(known))


def named(sensors: Sequence[str]) -> str:
    """Sensors as the subject of a sentence about what they read."""
    if len(sensors) == 1:
        return f"sensor {sensors[0]} reads"
    return f"sensors {', '.join(sensors)} read"
