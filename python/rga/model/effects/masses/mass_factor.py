"""Masses that are larger or smaller than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.masses.places import add_masses
from rga.model.parameter import Factor, Parameter, Place, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure

#: of a density; and of a mass on nodes, which may be another layer or engine altogether
USUAL, ON_NODES = Factor(0.04), Factor(0.04, tail=0.5)


class MassFactor(Effect):
    """A factor on the density of a material, or on a mass that the model states by its name.

    It changes natural frequencies alone. Several factors on one mass add up what each changes.
    """

    kind: Literal["mass_factor"] = "mass_factor"
    action = Action(
        inspect="layers and equipment on {place}",
        check="thicknesses and densities in the drawings against cores and weighings",
        test="park a vehicle of known mass: by it mass and stiffness are told apart",
    )
    usual = (
        f"factor {USUAL}: the weight of concrete has a coefficient of variation of 4 % (JCSS "
        "Probabilistic Model Code, 2.1); of a mass on nodes with a long tail, a judgement"
    )
    structural = True
    on_modes = True
    material: Annotated[str | list[str] | None, Place("material")] = None
    mass: Annotated[str | list[str] | None, Place("mass")] = None
    factor: Annotated[Value, Parameter("-", 1.0, least=0.0)] = 1.0

    def check(self, model: Model) -> None:
        if (self.material is None) == (self.mass is None):
            raise ValueError("mass_factor needs one place: give 'material' or 'mass'")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        heavy = [name for name, one in model.materials.items() if one.density]
        yield from ({"material": name} for name in heavy)
        if len(heavy) > 1:
            yield {"material": heavy}
        yield from ({"mass": name} for name in model.masses)
        if len(model.masses) > 1:
            yield {"mass": list(model.masses)}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": ON_NODES if "mass" in place else USUAL}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        stated = structure.once_for_geometry(
            lambda: structure.weigh(listed(self.material), listed(self.mass)), self
        )
        add_masses(structure, stated, value["factor"] - 1.0)
