"""Measurements of a context whose zero is off."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.contexts.places import Contexts, each_context
from rga.model.parameter import Normal, Parameter, Prior, Value, listed
from rga.model.schema import Model

USUAL = Normal(0.0, 0.05)


class ContextBias(Effect):
    """An offset of a context channel: measured = true + offset [its unit]."""

    kind: Literal["context_bias"] = "context_bias"
    action = Action(
        check="the zero of the sensor that measures {place}",
        test="read it beside a second instrument",
    )
    usual = f"offset {USUAL} times the range of the context: a judgement"
    context: Contexts
    offset: Annotated[Value, Parameter("unit", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from each_context(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        low, high = model.context[place["context"]].range
        return {"offset": USUAL.times(high - low)}

    def change_contexts(self, contexts: Values, values: Values) -> None:
        for name in listed(self.context):
            contexts[name] = contexts[name] - values["offset"]
