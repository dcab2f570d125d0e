"""Members that are stiffer or softer than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import Effect, Values
from rga.model.effects.temperature import Temperature
from rga.model.parameter import Driven, Factor, Normal, Parameter, Place, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure


class ElasticModulus(Effect):
    """A factor on the elastic modulus of a material."""

    kind: Literal["elastic_modulus"] = "elastic_modulus"
    structural = True
    material: Annotated[str | list[str], Place("material")]
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"material": material} for material in model.materials)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.1)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        made_of = structure.of_material(self.material)
        structure.arrays["E"][made_of] *= value["factor"]
        structure.arrays["G"][made_of] *= value["factor"]


class MemberStiffness(Effect):
    """A factor on EA and EI of members: section loss, a crack, corrosion, or a larger section."""

    kind: Literal["member_stiffness"] = "member_stiffness"
    structural = True
    member: Annotated[str | list[str] | None, Place("member")] = None
    group: Annotated[str | list[str] | None, Place("group")] = None
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from _members_and_groups(model, set(model.members))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.5 if "member" in place else 0.2)}

    def check(self, model: Model) -> None:
        some_member(self, self.member, self.group)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        chosen = structure.named(self.member, self.group)
        structure.arrays["E"][chosen] *= value["factor"]
        structure.arrays["G"][chosen] *= value["factor"]


class BendingStiffness(Effect):
    """A factor on EI alone of frame members: what bends is not what stretches.

    A flange that is lost or was added, a slab that cracks, a section that was laid on its side.
    """

    kind: Literal["bending_stiffness"] = "bending_stiffness"
    structural = True
    member: Annotated[str | list[str] | None, Place("member")] = None
    group: Annotated[str | list[str] | None, Place("group")] = None
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        frames = {name for name, member in model.members.items() if member.kind == "frame"}
        yield from _members_and_groups(model, frames)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return MemberStiffness.priors(model, place)

    def check(self, model: Model) -> None:
        some_member(self, self.member, self.group)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        chosen = structure.named(self.member, self.group)
        structure.arrays["Iy"][chosen] *= value["factor"]
        structure.arrays["Iz"][chosen] *= value["factor"]


class StiffnessTemperature(Effect):
    """EA that follows the temperature: times 1 + rate * (T - kink) where T is above the kink.

    T is the context that drives the model's `temperature` effects, late where a `thermal_lag` makes
    the members late. EI stays as it is.

    Attributes:
        rate: [1/K] of EA; negative where warmth softens.
        kink: temperature from which on the rate holds, EA being as modelled below it [degC].
            Left out, the rate holds at all temperatures, and EA is as modelled at the one
            that warms nothing.
    """

    kind: Literal["stiffness_temperature"] = "stiffness_temperature"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    rate: Annotated[Value, Parameter("1/K", 0.0)] = 0.0
    kink: Annotated[Value | None, Parameter("degC", None)] = None

    def check(self, model: Model) -> None:
        driven = _driven_temperatures(model)
        contexts = sorted({delta.context for delta in driven})
        if len(contexts) != 1:
            raise ValueError(
                "stiffness_temperature follows the one context that drives the temperature "
                f"effects, and here it is {' and '.join(contexts) or 'none'}"
            )
        if self.kink is None and len({delta.minus for delta in driven}) > 1:
            raise ValueError(
                "kink [degC] must be given: the temperature effects warm nothing at different "
                "temperatures"
            )

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        driven = _driven_temperatures(model)
        if len({(delta.context, delta.minus) for delta in driven}) == 1:
            yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"rate": Normal(0.0, 0.003)}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        # The factor itself is the parameter of the structure: stiffnesses are straight in it.
        warm = next(other for other in all_values.values() if "reference" in other)
        above = warm["temperature"] - values.pop("kink", warm["reference"])
        if self.kink is not None:
            above = np.maximum(above, 0.0)
        values["factor"] = 1.0 + values.pop("rate") * above

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"], "reduce the rate, or give another kink")
        structure.arrays["A"][structure.named(None, self.group)] *= value["factor"]


def _members_and_groups(model: Model, members: set[str]) -> Iterator[dict[str, Any]]:
    """Some members one by one, and the groups that hold more than one of them."""
    yield from ({"member": name} for name in model.members if name in members)
    for group, names in model.groups.items():
        if len(members.intersection(names)) > 1:
            yield {"group": group}


def _driven_temperatures(model: Model) -> list[Driven]:
    """What drives the temperature effects of a model."""
    deltas = (one.delta for one in model.effects.values() if isinstance(one, Temperature))
    return [delta for delta in deltas if isinstance(delta, Driven)]


def positive(effect: Effect, factor: float, remedy: str = "give a factor above 0") -> None:
    """InputError where a factor on a stiffness is not positive."""
    if not factor > 0:
        raise InputError(
            f"the factor {factor:g} leaves no stiffness", f"{effect.kind} of {effect.place}", remedy
        )


def some_member(
    effect: Effect, member: str | list[str] | None, group: str | list[str] | None
) -> None:
    """ValueError where a place names neither members nor groups."""
    if not listed(member) + listed(group):
        raise ValueError(f"{effect.kind} needs a place: give 'member' or 'group'")
