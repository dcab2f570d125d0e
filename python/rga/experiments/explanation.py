"""An explanation: effects beside those of a model, known no better than their intervals say."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import Effect
from rga.model.parameter import Estimated, Normal, Prior
from rga.model.schema import Model

#: half width of a 90 % interval in standard deviations
HALF_WIDTH = 1.6449
#: a fit may move each of several unknowns of an effect as if its interval were so many times as
#: wide: where one trades against the other, the intervals are no good account of a record
DOUBT = 2.0


@dataclass(frozen=True)
class UncertainParameter:
    """A parameter that is known to within an interval.

    Attributes:
        effect, parameter: their names.
        prior: the scale on which the parameter is about normal.
        centre, spread: mean and standard deviation on that scale.
    """

    effect: str
    parameter: str
    prior: Prior
    centre: float
    spread: float


@dataclass(frozen=True)
class CandidateModel:
    """What a model may lack.

    Attributes:
        words: in words.
        effects: as they are now, at their likeliest, by names that are new to the model.
        unknowns: parameters of theirs that are not sure.
    """

    words: str
    effects: Mapping[str, Effect]
    unknowns: tuple[UncertainParameter, ...]

    @property
    def spread(self) -> FloatArray:
        """How far a fit may move each unknown [standard deviations], float[unknowns]."""
        of = [unknown.effect for unknown in self.unknowns]
        return np.array([DOUBT if of.count(one) > 1 else 1.0 for one in of])

    def at(self, steps: Sequence[float] | FloatArray) -> dict[str, Effect]:
        """The effects with unknowns so many standard deviations off their likeliest values."""
        effects = dict(self.effects)
        for unknown, step in zip(self.unknowns, steps, strict=True):
            value = unknown.prior.value(unknown.centre + float(step) * unknown.spread)
            effects[unknown.effect] = effects[unknown.effect].with_values(
                {unknown.parameter: value}
            )
        return effects


def explanation(words: str, model: Model, effects: Sequence[Effect]) -> CandidateModel:
    """An explanation by effects as a diagnosis found them.

    Onsets are left out: what is planned comes after them.

    Args:
        words: in words.
        model: to which the effects would be added.
        effects: their estimated parameters with intervals.

    Raises:
        InputError: a value or an interval that its parameter cannot have.
    """
    named, unknowns = {}, []
    for number, effect in enumerate(effects):
        name = f"explanation {number + 1}"
        named[name] = effect.model_copy(update={"onset": None, "end": None, "profile": "step"})
        priors = type(effect).priors(model, effect.place)
        for parameter in effect.parameters():
            stated = getattr(effect, parameter)
            if isinstance(stated, Estimated):
                prior = priors.get(parameter, Normal(0.0, 1.0))
                unknowns.append(_unknown(name, effect, parameter, stated, prior))
    return CandidateModel(words, named, tuple(unknowns))


def _unknown(
    name: str, effect: Effect, parameter: str, stated: Estimated, prior: Prior
) -> UncertainParameter:
    try:
        with np.errstate(invalid="ignore", divide="ignore"):
            low, centre, high = (prior.z(v) for v in (stated.ci90[0], stated.value, stated.ci90[1]))
    except ValueError:  # the logarithm of what cannot be negative
        low = centre = high = float("nan")
    spread = (high - low) / (2 * HALF_WIDTH)
    if not (isfinite(centre) and isfinite(spread) and spread >= 0):
        raise InputError(
            f"the {parameter} {stated.value:g} within {list(stated.ci90)} cannot be",
            f"findings, {effect.kind}",
            "give findings as the diagnosis wrote them",
        )
    return UncertainParameter(name, parameter, prior, centre, spread)
