"""Which way to infer contexts is taken, by what each predicts of rows that it has not seen."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.inference import Joint, MeasuredContexts
from rga.inference.joint.infer import RowModes
from rga.inference.map.array_simulator import TwinOnArrays
from rga.simulation import Simulator
from rga.twin.calibration.joint_posterior import (
    JointEstimator,
    instruments,
    readings_of,
    why_not,
)
from rga.twin.calibration.lesson import Lesson
from rga.twin.settings import Inference

#: rows of a stretch at most, of which one in so many is held out: neighbours are too much alike
STRETCH, HELD_OUT = 8, 5
#: the joint posterior may predict worse than the model as given by this factor
AS_GOOD = 1.05


@dataclass(frozen=True)
class InferenceChoice:
    """What was chosen.

    Attributes:
        inference: the way to infer.
        words: what, and why.
        begun: what the joint posterior has found of a part of the rows.
        optimism: gap of rows that nothing was learned from, over that of the others [-].
    """

    inference: Inference
    words: str
    begun: Joint | None = None
    optimism: float = 1.0


def choose(lesson: Lesson) -> InferenceChoice:
    """The joint posterior where it can be had and predicts, networks otherwise.

    It learns from four fifths of the rows. From one half of the channels the contexts of the other
    rows are inferred, and the other half of the channels is predicted; so it is by the model as
    given, at the contexts that suit it best.
    """
    reason = why_not(lesson)
    if reason is not None:
        words = f"contexts by networks (not by the joint posterior: {reason})"
        return InferenceChoice("networks", words)
    rows = np.arange(len(lesson.data.real))
    held = rows // min(STRETCH, len(rows) // HELD_OUT) % HELD_OUT == HELD_OUT - 1
    learned = JointEstimator.learn(lesson.rows(~held))
    found, own = learned.found, lesson.noise[learned.watched]
    readings = readings_of(lesson, found.unknowns, learned.watched)
    measured = instruments(lesson.simulation, lesson.data.real_contexts)
    joint = RowModes(found.twin, found.variance, found.source, measured, found.uncertainty)
    twin = TwinOnArrays(Simulator(found.unknowns.model), time=lesson.clock)
    given = RowModes(twin, own**2, found.source, measured)
    off = readings[~held] - given.simulate(given(readings[~held], _rows(measured, ~held)).value)
    # What the model is off by counts as noise, as it does for the joint posterior.
    count = np.isfinite(off).sum(axis=0)
    variance = np.maximum(np.nansum(off**2, axis=0) / np.maximum(count, 1), own**2)
    given = RowModes(twin, variance, found.source, measured)
    unseen = readings[held], _rows(measured, held)
    mine, others = (_off_by(one, *unseen, own) for one in (joint, given))
    words = (
        f"on {held.sum()} rows held out it predicts half of the channels from the others to "
        f"{mine:.2g} times their noise, the model as given to {others:.2g} times"
    )
    seen = readings[~held], _rows(measured, ~held)
    ratio = _gap(joint, *unseen, own) / _gap(joint, *seen, own)
    optimism = max(ratio, 1.0) if np.isfinite(ratio) else 1.0
    if mine <= AS_GOOD * others:
        return InferenceChoice(
            "joint",
            f"contexts by the joint posterior, which corrects the structure as well: {words}",
            found,
            optimism,
        )
    words = f"contexts by networks, not by the joint posterior: {words}"
    return InferenceChoice("networks", words, found, optimism)


def _rows(measured: MeasuredContexts, chosen: NDArray[np.bool_]) -> MeasuredContexts:
    return MeasuredContexts(measured.values[chosen], measured.noise)


def _gap(
    modes: RowModes, readings: FloatArray, measured: MeasuredContexts, noise: FloatArray
) -> float:
    """Gap of rows at their contexts: the median of mean squares [variances of the noise]."""
    off = (readings - modes.simulate(modes(readings, measured).value)) / noise
    off = off[np.isfinite(off).any(axis=1)]
    return float(np.median(np.nanmean(off**2, axis=1))) if len(off) else np.nan


def _off_by(
    modes: RowModes, readings: FloatArray, measured: MeasuredContexts, noise: FloatArray
) -> float:
    """What half of the channels is off by, predicted from the others [spreads of their noise].

    The root of the median over rows of mean squares.
    """
    squares = np.full(readings.shape, np.nan)
    for half in (0, 1):
        hidden = np.arange(len(noise)) % 2 == half
        found = modes(np.where(hidden, np.nan, readings), measured)
        off = (readings - modes.simulate(found.value)) / noise
        squares[:, hidden] = off[:, hidden] ** 2
    known = np.isfinite(squares).any(axis=1)
    return float(np.sqrt(np.median(np.nanmean(squares[known], axis=1)))) if known.any() else np.inf
