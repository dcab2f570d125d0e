"""A material that is stiffer or softer than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.positive import positive
from rga.model.parameter import Factor, Parameter, Place, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Factor(0.1)


class ElasticModulus(Effect):
    """A factor on the elastic modulus of a material."""

    kind: Literal["elastic_modulus"] = "elastic_modulus"
    action = Action(
        inspect="nothing on the structure: all members of {place} answer alike",
        check=(
            "the modulus and the sections in the drawings, the weights of the loads, and the "
            "calibration of all gauges together: a common factor is in one of them"
        ),
        test="{load}: known weights separate the stiffness from the load",
    )
    usual = (
        f"factor {USUAL}: a judgement; the modulus of steel has a coefficient of variation of 3 % "
        "(JCSS Probabilistic Model Code, 3.2), that of concrete a larger one"
    )
    structural = True
    material: Annotated[str | list[str], Place("material")]
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"material": material} for material in model.materials)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        made_of = structure.of_material(self.material)
        structure.arrays["E"][made_of] *= value["factor"]
        structure.arrays["G"][made_of] *= value["factor"]
