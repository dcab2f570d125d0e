"""The conditions under which a case is recorded, whatever is hidden in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.noise import autoregressive, heavy_tailed
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts

#: how much hotter the rows after the record are [K], and how much heavier the loads [-]
HOTTER, HEAVIER = 12.0, 1.25
_GRID = 1.5  # rows of the even grid that a row of an uneven record is taken from
_MEMORY = 0.6
_EXACT = 1e-5  # of its range: the noise that a model states of a context that is known
_OFF = 2.0


@dataclass(frozen=True)
class Conditions:
    """How a case is recorded.

    Attributes:
        noise: of the sensors: "memory" is AR(1) drawn from 0.2 to 0.7, "long memory" is 0.6.
        contexts: "measured" with the errors of healthy sensors, "known" exactly, "off" by twice
            those errors; or "latent": one of them, temperature or load, was not measured.
        scatter: standard deviation of the members' stiffness [-], with half of it on the
            channels' gains; None: drawn.
        sampling: rows in even steps, with two gaps, or in uneven steps.
        ramps: whether an effect that begins late may grow rather than jump.
        later: rows after the record that the analyser does not get, hotter and heavier loaded.
        unseen: share of the sensors that the analyser does not get.
    """

    noise: Literal["memory", "white", "long memory", "heavy tails"] = "memory"
    contexts: Literal["measured", "known", "off", "latent"] = "measured"
    scatter: float | None = None
    sampling: Literal["even", "gaps", "uneven"] = "even"
    ramps: bool = False
    later: int = 0
    unseen: float = 0.0

    @property
    def error(self) -> float:
        """The errors of measured contexts, in those of healthy sensors."""
        return {"known": 0.0, "off": _OFF}.get(self.contexts, 1.0)

    def memory(self, drawn: Array) -> Array:
        """The memory phi of the channels, where ``drawn`` is what would be drawn."""
        if self.noise == "memory":
            return drawn
        return np.full_like(drawn, _MEMORY if self.noise == "long memory" else 0.0)

    def readings_noise(self, rng: np.random.Generator, rows: int, sd: Array, phi: Array) -> Array:
        """Noise of the channels on the even grid, [rows, c]."""
        if self.noise == "heavy tails":
            return heavy_tailed(rng, rows, sd)
        return autoregressive(rng, rows, sd, phi)

    def grid(self, rows: int) -> int:
        """Rows of the even grid from which ``rows`` are kept."""
        return rows if self.sampling == "even" else int(_GRID * rows)

    def kept(self, rng: np.random.Generator, rows: int) -> np.ndarray:
        """Numbers of the rows of the even grid that are in the record, int [rows]."""
        grid = self.grid(rows)
        if self.sampling == "uneven":
            return np.sort(rng.choice(grid, rows, replace=False))
        lost = grid - rows
        first = int(rng.uniform(0.15, 0.45) * rows)
        second = first + int(rng.uniform(0.2, 0.4) * rows)
        row = np.arange(rows)
        return np.asarray(row + lost // 2 * (row >= first) + (lost - lost // 2) * (row >= second))

    def latent(self, rng: np.random.Generator, bridge: Bridge) -> frozenset[str]:
        """Names of the contexts that were not measured."""
        role = ("temperature", "area")[int(rng.integers(2))]
        return frozenset([bridge.roles[role]] if self.contexts == "latent" else [])

    def state_noise(self, bridge: Bridge) -> None:
        """Let the model say of contexts that are known that they are."""
        if self.contexts == "known":
            for variable in bridge.model["context"].values():
                low, high = variable["range"]
                variable["noise"] = _EXACT * (high - low)


def heavier(bridge: Bridge, contexts: Contexts) -> Contexts:
    """Contexts of days that the record has not seen, within their ranges."""
    temperature, area = bridge.roles["temperature"], bridge.roles["area"]
    out = {
        **contexts,
        temperature: contexts[temperature] + HOTTER,
        area: contexts[area] * HEAVIER,
    }
    ranges = bridge.model["context"]
    return {name: np.clip(course, *ranges[name]["range"]) for name, course in out.items()}
