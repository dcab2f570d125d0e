"""Modes that a tracker takes for each other."""

from typing import Annotated, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.parameter import Place
from rga.model.readings import Readings
from rga.model.schema import Model


class ModeSwap(Effect):
    """Two modes of which each is recorded under the name of the other.

    Sensors of their frequencies, and of their shapes at points that both have, show those of the
    other mode. A diagnosis never proposes it: it takes no name of a mode for granted, and finds out
    in every window which mode is which.
    """

    kind: Literal["mode_swap"] = "mode_swap"
    action = Action(
        check="the names that the identification gives {place}, window by window, by their shapes",
        test="a longer window, in which close modes part",
    )
    on_sensors = True
    on_modes = True
    modes: Annotated[tuple[str, str], Place("mode")]

    def check(self, model: Model) -> None:
        if len(set(self.modes)) < 2:
            raise ValueError("modes: name two that differ")

    def change_readings(self, readings: Readings, values: Values) -> None:
        swapped = self.weight(readings.time) > 0
        one, other = (readings.modes.get(name, {}) for name in self.modes)
        for point in one.keys() & other.keys():
            first, second = one[point], other[point]
            shown = readings.values[swapped][:, [second, first]]
            readings.values[swapped, first], readings.values[swapped, second] = shown.T
