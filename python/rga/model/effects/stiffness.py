"""Members that are stiffer or softer than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.errors import InputError
from rga.model.effect import Effect
from rga.model.parameter import Factor, Parameter, Place, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure


class ElasticModulus(Effect):
    """A factor on the elastic modulus of a material."""

    kind: Literal["elastic_modulus"] = "elastic_modulus"
    structural = True
    material: Annotated[str, Place("material")]
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
        yield from ({"member": member} for member in model.members)
        yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.5 if "member" in place else 0.2)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        chosen = structure.named(self.member, self.group)
        structure.arrays["E"][chosen] *= value["factor"]
        structure.arrays["G"][chosen] *= value["factor"]


def positive(effect: Effect, factor: float) -> None:
    """InputError where a factor on a stiffness is not positive."""
    if not factor > 0:
        raise InputError(
            f"the factor {factor:g} leaves no stiffness",
            f"{effect.kind} of {effect.place}",
            "give a factor above 0",
        )
