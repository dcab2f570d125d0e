"""What happens on the bridge of the case study: ordinary days, and an event unlike them."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.bridges.case_study import SPAN
from rga_bench.synthetic.noise import autoregressive
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts

_DAY = 86400.0
_RAMP = 4  # rows in which the event comes and goes
_MEMORY = np.array([0.98, 0.95, 0.9, 0.95, 0.95, 0.97])


def ordinary(rng: np.random.Generator, time: Array) -> Contexts:
    """True contexts [n] at ``time`` [s], in the order of the model."""
    days = time / _DAY + rng.uniform()
    sun = np.maximum(np.sin(2 * np.pi * (days - 0.25)), 0.0)
    busy = 0.5 + 0.5 * np.sin(2 * np.pi * (days - rng.uniform(0.3, 0.4)))
    weather, cloud, visits, walk, lean, gust = np.tanh(
        0.8 * autoregressive(rng, len(time), np.ones(6), _MEMORY)
    ).T
    mean, wave, night, heat = rng.uniform([-8, 5, -2, 6], [8, 9, -0.5, 11])
    return {
        "temperature": mean + wave * np.sin(2 * np.pi * (days - 0.4)) + 2.5 * weather,
        "gradient": night + heat * sun * (0.7 + 0.3 * cloud),
        "crowd": 0.3 + 2.2 * np.clip(0.15 + 0.55 * busy + 0.3 * visits, 0.0, 1.0),
        "position": SPAN * (0.5 + 0.15 * walk),
        "eccentricity": 0.3 * lean,
        "wind": 0.5 * gust,
    }


def event(rng: np.random.Generator, contexts: Contexts, slow: bool) -> tuple[Contexts, Array]:
    """``contexts`` with an event in them, and how far it is on in every row, [n] in 0..1.

    A crowd beyond its stated range stands near one end and on one side of the deck. It comes and
    goes, or (``slow``) it gathers up to the last row.
    """
    rows = len(contexts["crowd"])
    first, last = (np.array(rng.uniform([0.38, 0.57], [0.42, 0.62])) * rows).astype(int)
    row = np.arange(rows)
    if slow:
        weight = np.clip((row - first) / (rows - 1 - first), 0.0, 1.0)
    else:
        weight = np.clip(np.minimum(row - first, last - row) / _RAMP, 0.0, 1.0)
    restless = np.tanh(autoregressive(rng, rows, np.ones(3), np.full(3, 0.9))).T
    end, side = rng.choice([-1.0, 1.0], 2)
    there = {
        "crowd": rng.uniform(5.4, 6.2) + 0.8 * restless[0],
        "position": SPAN * (0.5 + end * (0.27 + 0.02 * restless[1])),
        "eccentricity": side * (0.5 + 0.08 * restless[2]),
    }
    mixed = {name: contexts[name] + weight * (there[name] - contexts[name]) for name in there}
    return {**contexts, **mixed}, weight
