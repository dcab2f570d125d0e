"""What model updating may change in a model, as contexts drive it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rga.inference.joint.joint_stiffness_surrogate import BENDING
from rga.model import Model
from rga.model.effect import Effect
from rga.model.effects.members.elastic_modulus import ElasticModulus
from rga.model.effects.members.member_stiffness import MemberStiffness
from rga.model.effects.supports.support_flexibility import SupportFlexibility
from rga.model.effects.temperature.thermal_expansion import ThermalExpansion
from rga.model.parameter import Driven, Factor, Positive

#: fixity of joints beforehand: share of the bending stiffness of rigid ones, and its log spread
FIXITY = (0.3, 1.5)


@dataclass(frozen=True)
class UpdatedParameter:
    """A parameter that is updated: log-normal beforehand.

    Attributes:
        effect: kind and place of the effect, with any value of the parameter.
        parameter: its name.
        median, spread: value of the middle, and standard deviation of its natural logarithm.
    """

    effect: Effect
    parameter: str
    median: float
    spread: float

    def driven(self, context: str) -> Effect:
        """The effect with its parameter as a power of ten of a context."""
        follows = Driven(context=context, times=self.median, log10=True)
        return self.effect.model_copy(update={self.parameter: follows})

    def at(self, z: float) -> Effect:
        """The effect with its parameter z standard deviations from the middle."""
        return self.effect.with_values(
            {self.parameter: self.median * float(np.exp(self.spread * z))}
        )


def unknowns(model: Model) -> Iterator[UpdatedParameter]:
    """Elastic modulus and thermal expansion of materials, stiffness of the group that a member
    names first, and upright flexibility of each support.
    """
    first = dict.fromkeys(member.groups[0] for member in model.members.values() if member.groups)
    places: list[tuple[type[Effect], dict[str, object]]] = [
        (kind, place) for kind in (ElasticModulus, ThermalExpansion) for place in kind.places(model)
    ]
    places += [(MemberStiffness, {"group": group}) for group in first]
    places += [
        (SupportFlexibility, place)
        for place in SupportFlexibility.places(model)
        if place["dof"] == "uz" and isinstance(place["support"], str)
    ]
    for kind, place in places:
        ((parameter, prior),) = kind.priors(model, place).items()
        if not isinstance(prior, Factor | Positive):
            raise TypeError(f"the prior of {parameter} is not log-normal")
        median = prior.value(0.0)
        effect = kind.model_validate({**place, parameter: median})
        yield UpdatedParameter(effect, parameter, median, prior.spread)
    if BENDING in model.groups:
        fixity, spread = FIXITY
        yield UpdatedParameter(
            MemberStiffness(group=BENDING, factor=fixity), "factor", fixity, spread
        )
