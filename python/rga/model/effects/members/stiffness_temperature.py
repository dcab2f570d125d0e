"""Members whose stiffness follows the temperature."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AliasChoices, Field

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.members.positive import positive
from rga.model.effects.temperature.temperature import Temperature
from rga.model.effects.temperature.thermal_lag import ThermalLag
from rga.model.parameter import Driven, Normal, Parameter, Place, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Normal(0.0, 0.003)
#: asphalt and soil that freeze stiffen a deck by per cent a kelvin, about 0 degC (Peeters and De
#: Roeck, One-year monitoring of the Z24-Bridge, Earthquake Engng Struct. Dyn. 30, 2001)
FROST, FREEZING = Normal(0.0, 0.01), Normal(0.0, 3.0)
#: change of the stiffness within a kelvin beyond which it is a slip: of per cent for a share
STEEPEST = 0.5


class StiffnessTemperature(Effect):
    """EA, EI or both that follow the temperature: times 1 + rate * (T - kink) above the kink.

    Below the kink the factor is 1 + below * (T - kink): asphalt and soil stiffen by much more when
    they freeze than they soften when it is warm. T is the context that drives the model's
    `temperature` effects, of which there must be exactly one, late where a `thermal_lag` makes the
    members late.

    Attributes:
        rate: [1/K] of the stiffness; negative where a higher temperature softens. A file may call
            it `above`, beside `below`.
        kink: temperature from which on the rate holds [degC]. Left out, the rate holds at all
            temperatures, and the stiffness is as modelled at the one that warms nothing.
        below: [1/K] of the stiffness below the kink, where it is as modelled unless this is given.
        of: what follows; EI is that of members that bend, both have GJ with them.
    """

    kind: Literal["stiffness_temperature"] = "stiffness_temperature"
    action = Action(
        inspect="joints and surfacing of {place} when it is cold and when it is warm",
        check="the temperature sensor, and whether the deck or its surfacing bears a share",
        test="the same known load on a cold and on a warm day",
    )
    usual = (
        f"rate {USUAL} 1/K: a judgement; in modes also below {FROST} 1/K with kink {FREEZING} "
        "degC: asphalt that freezes, as on the bridge Z24"
    )
    structural = True
    group: Annotated[str | list[str], Place("group")]
    rate: Annotated[
        Value, Parameter("1/K", 0.0), Field(validation_alias=AliasChoices("rate", "above"))
    ] = 0.0
    kink: Annotated[Value | None, Parameter("degC", None)] = None
    below: Annotated[Value, Parameter("1/K", 0.0)] = 0.0
    of: Literal["EA", "EI", "both"] = "EA"

    def check(self, model: Model) -> None:
        for name in ("rate", "below"):
            slope = getattr(self, name)
            if isinstance(slope, int | float) and abs(slope) > STEEPEST:
                raise ValueError(
                    f"{name} is {slope:g} 1/K, by which the stiffness changes by "
                    f"{100 * abs(slope):g} % within a kelvin: give a share, such as -0.02"
                )
        if self.kink is None and "below" in self.model_fields_set:
            raise ValueError("below [1/K] holds below a kink: give kink [degC] too")
        several = [model.members[name] for one in listed(self.group) for name in model.groups[one]]
        if self.of == "EI" and all(member.kind != "frame" for member in several):
            raise ValueError("no member of the group bends, so none has an EI: give of EA or both")
        driven = driven_temperatures(model)
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
        driven = driven_temperatures(model)
        if len({(delta.context, delta.minus) for delta in driven}) == 1:
            yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"rate": USUAL}

    @classmethod
    def forms_on_modes(cls) -> list[dict[str, Prior]]:
        """Sets of parameters that frequencies may show: over seasons also a kink."""
        return [{"rate": USUAL}, {"rate": USUAL, "below": FROST, "kink": FREEZING}]

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        # The factor itself is the parameter of the structure: stiffnesses are linear in it.
        warm = next(other for other in all_values.values() if "reference" in other)
        warmer = warm["temperature"] - values.pop("kink", warm["reference"])
        rate, below = values.pop("rate"), values.pop("below")
        slope = rate if self.kink is None else np.where(warmer > 0.0, rate, below)
        values["factor"] = 1.0 + slope * warmer

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"], "reduce rate or below, or give another kink")
        chosen, given = structure.named(None, self.group), structure.arrays
        scaled = {
            "EA": (given["A"],),
            "EI": (given["Iy"], given["Iz"]),
            "both": (given["E"], given["G"]),
        }
        for each in scaled[self.of]:
            each[chosen] *= value["factor"]


def driven_temperatures(model: Model) -> list[Driven]:
    """What drives the temperature effects of a model."""
    deltas = (one.delta for one in model.effects.values() if isinstance(one, Temperature))
    return [delta for delta in deltas if isinstance(delta, Driven)]


def contexts_of_temperature(model: Model) -> set[str]:
    """Contexts whose rows tell how warm members are; none where these are late behind them."""
    if any(isinstance(one, ThermalLag) for one in model.effects.values()):
        return set()
    return {delta.context for delta in driven_temperatures(model)}
