"""What is true of a case, in the measures of a diagnosis: its size, and a fit of the true kind.

The judge knows what is hidden, so the covariance is that of the record without it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.held_out import held_out_rows
from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.prepare import prepare
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.diagnosis.search.laplace import FARTHEST, extended, fit
from rga.diagnosis.search.linearised import Problem, pose, relaxed
from rga.diagnosis.search.screening import Screening
from rga.diagnosis.search.stepwise import settled
from rga.errors import InputError
from rga.model.schema import Model
from rga.records import Record
from rga.simulation import Simulator
from rga_bench.diagnosis.hidden import Truth, stiff_joints
from rga_bench.synthetic import Case

#: rivals that are fitted to find the nearest
RIVALS = 6
NORMAL_90 = 1.6448536269514722


@dataclass(frozen=True)
class Size:
    """d' of a hidden effect, and d' once its nearest rival has imitated all it can."""

    d_prime: float
    d_perp: float
    nearest: dict[str, Any] | None = None


class ReferenceFit:
    """A case posed as its diagnosis poses it."""

    def __init__(self, case: Case, model: Model, record: Record) -> None:
        assert case.beyond is not None
        self._case, self._beyond = case, case.beyond
        self._base = Simulator(model)
        prepared = prepare(model, record, lambda done: None)
        self._data = prepared.data.rows(~held_out_rows(len(prepared.data.time)))
        order = {name: number for number, name in enumerate(case.beyond.sensors)}
        self._columns = np.array([order[name] for name in self._data.sensors], dtype=np.int64)
        self._rows = np.searchsorted(case.time, self._data.time)
        self._candidates = hypotheses(model, self._data.sensors, set(record.contexts))
        self._truths = Truth.of(case)
        healthy = self._data.readings - self._seen(self._beyond.together)
        self._healthy = settled(self._base, replace(self._data, readings=healthy))

    @cached_property
    def _screening(self) -> Screening:
        return Screening(self._healthy, self._base, self._candidates)

    def sizes(self) -> list[Size]:
        """d' and d_perp of every hidden effect."""
        return [
            # What a broken channel read before is no measure of how plainly it is broken.
            Size(truth.d_prime, truth.d_prime)
            if truth.kind == "sensor_fault"
            else self._size(self._healthy, truth, self._seen(change))
            for truth, change in zip(self._truths, self._beyond.signatures, strict=True)
        ]

    def deviations(self, beside_joints: bool) -> dict[str, dict[str, float]]:
        """By kind and parameter, how far the truth lies from a fit of all that is hidden.

        In standard deviations of the fit, on the scale on which the prior is normal.
        `beside_joints`: with the true stiffness of the joints fitted beside. Empty where what was
        fitted cannot be simulated.
        """
        chosen = [(truth, one) for truth in self._truths if (one := self._hypothesis(truth))]
        together = [(one, _z(one, _turned(truth, one.place))) for truth, one in chosen]
        joints = stiff_joints(self._case) if beside_joints else None
        if joints is not None:
            values = {"stiffness": float(joints.model_dump()["stiffness"])}
            truth = Truth("joint_rigidity", joints.place, values, None, None, 0.0)
            if (one := self._hypothesis(truth)) is not None:
                together.append((one, _z(one, values)))
        if not chosen:
            return {}
        z = np.concatenate([start for _, start in together])
        several = [one for one, _ in together]
        there = extended(self._base, several, z)
        try:
            problem = pose(there, self._data, self._healthy)
            problem = pose(there, relaxed(problem), problem)
            found = fit(problem, self._base, several, z)
        except InputError:
            # Where slack reaches, the truth is a mechanism for the loads that its noise suggests.
            return {}
        off = (z - found.z) / found.spreads()
        return {
            truth.kind: dict(zip(one.priors, map(float, off[where]), strict=True))
            for (truth, one), where in zip(chosen, found.slices(), strict=False)
        }

    def deviations_reported(self, truth: Truth, effect: dict[str, Any]) -> dict[str, float]:
        """The same of a cause that was named, by its own 90 % interval."""
        one = self._hypothesis(truth)
        if one is None:
            return {}
        off = {}
        values = _turned(truth, effect)
        for name, prior in one.priors.items():
            estimate = effect.get(name)
            if not isinstance(estimate, dict) or "ci90" not in estimate:
                continue
            low, high = (prior.z(end) for end in estimate["ci90"])
            middle, true = prior.z(estimate["value"]), prior.z(values[name])
            if np.isfinite([low, high, middle, true]).all() and high > low:
                off[name] = (true - middle) / ((high - low) / (2 * NORMAL_90))
        return off

    def _hypothesis(self, truth: Truth) -> Hypothesis | None:
        """The hypothesis that is true; None where none can be: another parameter."""
        for one in self._candidates:
            known = one.priors and one.priors.keys() <= truth.values.keys()
            if known and truth.is_at({"kind": one.name, **one.place}):
                return one.beginning(truth.onset, truth.profile, truth.end)
        return None

    def _seen(self, change: FloatArray) -> FloatArray:
        """A change of all channels over all rows on what is analysed, zero where missing."""
        return np.where(self._data.observed, change[np.ix_(self._rows, self._columns)], 0.0)

    def _size(self, problem: Problem, truth: Truth, change: FloatArray) -> Size:
        covariance = problem.covariance
        own = covariance.reduce(change.T[None])
        size = max(float(covariance.squares(own)[0]), 0.0)
        exact: Data = replace(
            problem.data, readings=problem.simulated + problem.shift + problem.tails + change
        )
        alone = replace(problem, data=exact)
        least, nearest = size, None
        true = [
            one
            for one in self._candidates
            if any(known.is_at({"kind": one.name, **one.place}) for known in self._truths)
        ]
        alike = self._candidates[0].beginning(truth.onset, truth.profile, truth.end)
        for prospect in self._screening.again(alone, self._base, true, alike)[:RIVALS]:
            one = fit(alone, self._base, [prospect.hypothesis], prospect.z)
            other = covariance.reduce((one.simulated - problem.simulated).T[None])
            across = float(covariance.product(own, other)[0, 0])
            left = size - across**2 / max(float(covariance.squares(other)[0]), 1e-300)
            if np.isfinite(one.log_evidence) and left < least:
                least = left
                nearest = {"kind": one.hypotheses[0].name, **one.hypotheses[0].place}
        return Size(float(np.sqrt(size)), float(np.sqrt(max(least, 0.0))), nearest)


def _z(one: Hypothesis, values: dict[str, float]) -> FloatArray:
    start = np.array([prior.z(values[name]) for name, prior in one.priors.items()])
    return np.asarray(np.clip(start, -FARTHEST, FARTHEST))


def _turned(truth: Truth, place: Mapping[str, Any]) -> dict[str, float]:
    """The true values in the direction that a place gives."""
    ours, theirs = truth.place.get("direction"), place.get("direction")
    sign = -1.0 if ours and theirs and np.dot(ours, theirs) < 0 else 1.0
    return {name: sign * value for name, value in truth.values.items()}
