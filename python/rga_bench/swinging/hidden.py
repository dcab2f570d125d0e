"""What is hidden in a structure that swings: kinds of the vocabulary."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rga_bench.field.hidden import KINDS as FIELD_KINDS
from rga_bench.field.hidden import FieldSetting
from rga_bench.swinging.vibration import SwingingWorld


class SwingingSpan(NamedTuple):
    """A place, the values between which an effect grows there by factors, and how it acts."""

    place: dict[str, Any]
    mild: float
    severe: float
    act: Callable[[SwingingWorld, float], None]
    parameter: str

    def at(self, level: float) -> float:
        """The value at a level of 0..1."""
        return float(self.mild * (self.severe / self.mild) ** level)


Draw = Callable[[SwingingWorld, FieldSetting, np.random.Generator], SwingingSpan | None]


def _of_field(kind: str) -> Draw:
    """A kind of the second generator, which acts on the structure or on its gauges."""

    def draw(
        swinging: SwingingWorld, setting: FieldSetting, rng: np.random.Generator
    ) -> SwingingSpan | None:
        span = FIELD_KINDS[kind].draw(setting, rng)
        if span is None:
            return None
        act = span.act
        return SwingingSpan(
            span.place, span.mild, span.severe, lambda one, x: act(one.world, x, None),
            span.parameter,
        )  # fmt: skip

    return draw


def _added_mass(
    swinging: SwingingWorld, setting: FieldSetting, rng: np.random.Generator
) -> SwingingSpan:
    """Something heavy on one of the nodes that carry."""
    node = str(
        rng.choice([one["node"] for one in swinging.world.structure.model["masses"].values()])
    )
    at = list(swinging.world.structure.model["nodes"]).index(node)

    def act(one: SwingingWorld, value: float) -> None:
        one.masses.nodal[at] += value

    stated = float(swinging.masses.nodal[at])
    return SwingingSpan({"node": node}, 0.02 * stated, 2.0 * stated, act, "mass")


def _mass_factor(
    swinging: SwingingWorld, setting: FieldSetting, rng: np.random.Generator
) -> SwingingSpan:
    """All that is carried weighs more than is said, or less."""
    severe = 2.0 if rng.random() < 0.7 else 0.5

    def act(one: SwingingWorld, value: float) -> None:
        one.masses.nodal *= value

    place = {"mass": list(swinging.world.structure.model["masses"])}
    return SwingingSpan(place, 1.01 if severe > 1.0 else 0.99, severe, act, "factor")


def _clock_rate(
    swinging: SwingingWorld, setting: FieldSetting, rng: np.random.Generator
) -> SwingingSpan:
    """A logger whose clock runs fast, or slow."""
    severe = float(rng.choice([1.1, 0.9]))

    def act(one: SwingingWorld, value: float) -> None:
        one.clock *= value

    return SwingingSpan({}, 1.0 + 0.02 * (severe - 1.0), severe, act, "factor")


#: what modes show
OF_MODES: dict[str, Draw] = {
    "member_stiffness": _of_field("member_stiffness"),
    "added_mass": _added_mass,
    "support_flexibility": _of_field("support_flexibility"),
    "mass_factor": _mass_factor,
    "support_spring": _of_field("support_spring"),
    "clock_rate": _clock_rate,
}
#: what gauges show beside modes
OF_GAUGES: dict[str, Draw] = {
    "load_scale": _of_field("load_scale"),
    "sensor_gain": _of_field("sensor_gain"),
}
