"""What an added effect, or a change of contexts, does to every sensor."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isnan
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from rga.arrays import FloatArray
from rga.bounded_files import bytes_of, fault_of
from rga.errors import InputError
from rga.files import as_path
from rga.model import Effect, Model, as_model, read_effect
from rga.model.effect import when_all_act
from rga.model.parameter import Estimated
from rga.simulation.simulator import Simulator

#: draws behind an interval, and the half width of a 90 % interval in standard deviations
DRAWS, HALF_WIDTH = 200, 1.6449

#: ranges that a setting may lie away from its own
FAR = 100


@dataclass(frozen=True)
class WhatIf:
    """Sensor values before and after a change.

    Attributes:
        sensors: names, in the order of the model.
        units: of the sensors.
        before, after: float[sensors].
        after_ci90, change_ci90: 90 % intervals of the value after, and of the change, from what
            is not sure of contexts and effects, float[sensors, 2]; None where all is taken as
            sure.
        contexts_before, contexts: the contexts on both sides; the same where an effect is added.
        warnings: where the answer reaches beyond what the model holds for, in words.
    """

    sensors: tuple[str, ...]
    units: tuple[str, ...]
    before: FloatArray
    after: FloatArray
    after_ci90: FloatArray | None
    change_ci90: FloatArray | None
    contexts_before: dict[str, float]
    contexts: dict[str, float]
    warnings: list[str] = field(default_factory=list)


def whatif(
    model: Model | str | Path,
    settings: Mapping[str, float],
    add: Mapping[str, Effect] | None = None,
    *,
    base: Mapping[str, float] | None = None,
    spread: Mapping[str, float] | None = None,
) -> WhatIf:
    """Compare the model with the same model after a change.

    Where effects are added, the model without and with them is compared at the same contexts. Where
    none is, contexts before are compared with those that are set.

    Args:
        model: the model, or its file.
        settings: context variables, and `time` [s] where it matters; without a time all effects
            act, those too that begin late.
        add: effects that the changed model has besides its own; one of the same name is replaced.
        base: contexts that are not set, and `time` [s]; mid-range where left out.
        spread: standard deviations of contexts of the base that are not sure.

    Raises:
        InputError: a setting is no context variable of the model, or an effect does not fit it.
    """
    model = as_model(model)
    check_settings(model, settings)
    middle = {name: sum(variable.range) / 2 for name, variable in model.context.items()}
    changed = model.extended(dict(add or {}))
    begun = when_all_act(changed.effects.values())
    if begun is not None and base is None:
        middle["time"] = begun
    contexts = {**middle, **(base or {}), **settings}
    # Without a base both sides stand at the same time: only what was set makes a difference.
    start = {"time": settings["time"]} if "time" in settings and base is None else {}
    first = contexts if add else {**middle, **(base or {}), **start}
    before = Simulator(model).predict(first)[0]
    after = Simulator(changed).predict(contexts)[0]
    warnings = []
    for name, variable in model.context.items():
        low, high = variable.range
        if not low <= contexts[name] <= high:
            warnings.append(
                f"{name} = {contexts[name]:g} lies outside its range "
                f"{low:g}..{high:g} {variable.unit}"
            )
    unsure = {name: s for name, s in (spread or {}).items() if s > 0}
    intervals: tuple[FloatArray | None, FloatArray | None] = (None, None)
    if unsure or any(_estimated(effect) for effect in changed.effects.values()):
        sure = (set(settings) if add else set(), set(settings))
        intervals = _intervals(model, changed, (first, contexts), unsure, sure)
    units = tuple(sensor.unit for sensor in model.sensors.values())
    without, having = ({name: table[name] for name in model.context} for table in (first, contexts))
    return WhatIf(tuple(model.sensors), units, before, after, *intervals, without, having, warnings)


def check_settings(model: Model, settings: Mapping[str, float]) -> None:
    """Refuse settings of contexts that the model does not have, or far from their ranges.

    Raises:
        InputError: names the context.
    """
    for name in settings:
        if name != "time" and name not in model.context:
            raise InputError(
                f"there is no context variable {name!r}",
                f"model {model.name!r}",
                "it has " + (", ".join(model.context) or "none"),
            )
    for name, variable in model.context.items():
        low, high = variable.range
        if isnan(settings.get(name, 0.0)):
            raise InputError(
                f"{name} = nan is no number",
                f"model {model.name!r}",
                f"give a value near {low:g}..{high:g} {variable.unit}",
            )
        far = FAR * (high - low)
        if name in settings and not low - far <= settings[name] <= high + far:
            raise InputError(
                f"{name} = {settings[name]:g} is more than {FAR} times its range away from it",
                f"model {model.name!r}",
                f"give a value near {low:g}..{high:g} {variable.unit}",
            )


def _intervals(
    model: Model,
    changed: Model,
    contexts: tuple[Mapping[str, float], Mapping[str, float]],
    spread: Mapping[str, float],
    sure: tuple[set[str], set[str]],
) -> tuple[FloatArray, FloatArray]:
    """90 % intervals of the values after and of the change, float[sensors, 2] each."""
    generator = np.random.default_rng(0)
    after, change = [], []
    for _ in range(DRAWS):
        off = {name: s * generator.standard_normal() for name, s in spread.items()}
        ends = []
        drawn = {name: _drawn(effect, generator) for name, effect in changed.effects.items()}
        for one, table, known in zip((model, changed), contexts, sure, strict=True):
            # What is set is sure; where it is set for one side alone, the other is what it was.
            moved = {
                name: value + (0.0 if name in known else off.get(name, 0.0))
                for name, value in table.items()
            }
            effects = {name: drawn[name] for name in one.effects}
            whole = one.model_copy(update={"effects": effects})
            ends.append(Simulator(whole).predict(moved)[0])
        after.append(ends[1])
        change.append(ends[1] - ends[0])
    quantiles = (np.quantile(table, [0.05, 0.95], axis=0).T for table in (after, change))
    whole_after, whole_change = quantiles
    return np.asarray(whole_after), np.asarray(whole_change)


def _estimated(effect: Effect) -> dict[str, Estimated]:
    """Parameters of an effect that a diagnosis estimated."""
    values = {name: getattr(effect, name) for name in effect.parameters()}
    return {name: value for name, value in values.items() if isinstance(value, Estimated)}


def _drawn(effect: Effect, generator: np.random.Generator) -> Effect:
    """The effect with estimated parameters drawn from their intervals."""
    values = {}
    for name, known in _estimated(effect).items():
        low, high = known.ci90
        step = generator.standard_normal()
        if low > 0:
            values[name] = known.value * (high / low) ** (step / (2 * HALF_WIDTH))
        else:
            values[name] = known.value + (high - low) / (2 * HALF_WIDTH) * step
    return effect.with_values(values) if values else effect


def read_effects(path: str | Path) -> dict[str, Effect]:
    """Effects from a JSON file: one effect, named after the file, or a table of named effects.

    Raises:
        InputError: the file cannot be read, or holds no effect of the vocabulary.
    """
    path = as_path(path, "effects")
    raw = bytes_of(path, "effect")
    try:
        content = json.loads(raw.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        what = f"this is no JSON: {fault_of(error)}"
        raise InputError(what, str(path), "mend the syntax") from None
    if not isinstance(content, dict):
        raise InputError("this is no effect", str(path), "give an object with a 'kind'")
    named = {path.stem: content} if "kind" in content else content
    return {name: effect_of(effect, name, str(path)) for name, effect in named.items()}


def effect_of(content: Any, name: str, where: str) -> Effect:
    """An effect of the vocabulary from its keys.

    Args:
        content: the keys.
        name: of the effect.
        where: it stands, for an error.

    Raises:
        InputError: it is none.
    """
    try:
        return read_effect(content, name)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        known = ", ".join(Effect.vocabulary[content["kind"]].model_fields)
        raise InputError(f"{name}.{key}: {first['msg']}", where, f"its keys are {known}") from None
    except ValueError as error:
        raise InputError(str(error), where, "name a kind of the vocabulary") from None
