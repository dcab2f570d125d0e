"""Measurements of a context whose scale is off."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.contexts.places import Contexts, each_context
from rga.model.parameter import Factor, Parameter, Prior, Value, listed
from rga.model.schema import Model

USUAL = Factor(0.15)


class ContextGain(Effect):
    """A factor on a context channel: measured = factor * true."""

    kind: Literal["context_gain"] = "context_gain"
    action = Action(
        check="the calibration of the sensor that measures {place}",
        test="read it beside a second instrument at two levels",
    )
    usual = f"factor {USUAL}: a judgement"
    context: Contexts
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_context(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL}

    def change_contexts(self, contexts: Values, values: Values) -> None:
        for name in listed(self.context):
            contexts[name] = contexts[name] / values["factor"]
