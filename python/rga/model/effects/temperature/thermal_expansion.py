"""Materials that expand otherwise than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.temperature.temperature import Temperature
from rga.model.parameter import Factor, Parameter, Place, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Factor(0.15)


class ThermalExpansion(Effect):
    """A factor on the coefficient of thermal expansion of a material."""

    kind: Literal["thermal_expansion"] = "thermal_expansion"
    action = Action(
        check=(
            "the expansion coefficient of {place} in the model, and the temperature sensor: too "
            "small a reading looks alike"
        ),
        test="a night with steady temperature and a clear day, without load",
    )
    usual = (
        f"factor {USUAL}: a judgement; concretes have 7 to 10 per million kelvin (EN 1991-1-5, "
        "annex C)"
    )
    structural = True
    material: Annotated[str | list[str], Place("material")]
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(isinstance(effect, Temperature) for effect in model.effects.values()):
            yield from ({"material": material} for material in model.materials)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        structure.alpha[structure.of_material(self.material)] *= value["factor"]
