"""What a change of context, or an added effect, does to every sensor."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rga.errors import InputError
from rga.model import Effect, Model, read_effect
from rga.model.parameter import FloatArray
from rga.simulation.simulator import Simulator


@dataclass(frozen=True)
class WhatIf:
    """Sensor values before and after a change.

    Attributes:
        sensors: names, in the order of the model.
        units: of the sensors.
        before, after: float[sensors].
        contexts: the contexts after the change.
        warnings: contexts outside their range, in words.
    """

    sensors: tuple[str, ...]
    units: tuple[str, ...]
    before: FloatArray
    after: FloatArray
    contexts: dict[str, float]
    warnings: list[str] = field(default_factory=list)


def whatif(
    model: Model, settings: Mapping[str, float], add: Mapping[str, Effect] | None = None
) -> WhatIf:
    """Compare the model at mid-range contexts with the same model after a change.

    Args:
        model: the model.
        settings: context variables after the change, and `time` [s] where it matters.
        add: effects that the changed model has besides its own; one of the same name is replaced.

    Raises:
        InputError: a setting is no context variable of the model, or an effect does not fit it.
    """
    for name in settings:
        if name != "time" and name not in model.context:
            raise InputError(
                f"there is no context variable {name!r}",
                f"model {model.name!r}",
                "it has " + (", ".join(model.context) or "none"),
            )
    middle = {name: sum(variable.range) / 2 for name, variable in model.context.items()}
    contexts = {**middle, **settings}
    # At the same time on both sides, so that only what was set makes a difference.
    start = {"time": settings["time"]} if "time" in settings else {}
    before = Simulator(model).predict({**middle, **start})[0]
    after = Simulator(model.extended(dict(add or {}))).predict(contexts)[0]
    warnings = []
    for name, variable in model.context.items():
        low, high = variable.range
        if not low <= contexts[name] <= high:
            warnings.append(
                f"{name} = {contexts[name]:g} lies outside its range "
                f"{low:g}..{high:g} {variable.unit}"
            )
    units = tuple(sensor.unit for sensor in model.sensors.values())
    return WhatIf(tuple(model.sensors), units, before, after, contexts, warnings)


def read_effects(path: str | Path) -> dict[str, Effect]:
    """Effects from a JSON file: one effect, named after the file, or a table of named effects.

    Raises:
        InputError: the file cannot be read, or holds no effect of the vocabulary.
    """
    path = Path(path)
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        reason = (error.strerror or "unreadable").lower()
        raise InputError(
            f"the effect cannot be read, {reason}", str(path), "check the path"
        ) from None
    except ValueError as error:
        raise InputError(f"this is no JSON: {error}", str(path), "mend the syntax") from None
    if not isinstance(content, dict):
        raise InputError("this is no effect", str(path), "give an object with a 'kind'")
    named = {path.stem: content} if "kind" in content else content
    return {name: _effect(effect, name, str(path)) for name, effect in named.items()}


def _effect(content: Any, name: str, where: str) -> Effect:
    try:
        return read_effect(content, name)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        known = ", ".join(Effect.vocabulary[content["kind"]].model_fields)
        raise InputError(f"{name}.{key}: {first['msg']}", where, f"its keys are {known}") from None
    except ValueError as error:
        raise InputError(str(error), where, "name a kind of the vocabulary") from None
