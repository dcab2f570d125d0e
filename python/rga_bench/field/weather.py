"""How contexts move: shapes and families that the first generator does not use."""

from __future__ import annotations

import numpy as np
from scipy.stats import norm

from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure
from rga_bench.field.world import Contexts

_DAY = 86400.0
#: shape of the mean wind's Weibull distribution: 2, as in EN 1991-1-4's background documents
_WEIBULL = 2.0
#: sizes of the errors of healthy sensors, in their context's size; kelvin for the air
_ERRORS = {
    "air": 0.3,  # class B of IEC 60751 at 0 degC
    "wind": 0.02,  # cup anemometer of class 1, twice 1 % on the speed's square
    "snow": 0.02,  # snow scales
    "traffic": 0.02,  # weighing in motion, summed over many axles
    "trolley": 0.004,  # laser distance on a runway
    "hoist": 0.005,  # load cell of class C1 with its dynamics
}


def courses(structure: FieldStructure, rng: np.random.Generator, time: Array) -> Contexts:
    """True contexts [n] each, within their ranges."""
    days = time / _DAY
    out = {}
    for name, (mood, size) in structure.moods.items():
        low, high = structure.model["context"][name]["range"]
        if mood == "air":
            course = _air(rng, days)
        elif mood == "wind":
            course = size * _wind(rng, days)
        elif mood == "snow":
            course = size * _snow(rng, len(time))
        elif mood == "traffic":
            rush = 0.3 + np.abs(np.sin(2.0 * np.pi * days + rng.uniform(0.0, 6.28))) ** 3
            course = size * rush * rng.exponential(1.0, len(time))
        elif mood == "trolley":
            course = size * rng.beta(1.5, 1.5, len(time))
        else:
            lifted = rng.random(len(time)) < 0.7
            course = np.where(lifted, size * rng.lognormal(-0.2, 0.5, len(time)), 0.0)
        out[name] = np.clip(course, low, high)
    return out


def measured(
    structure: FieldStructure, rng: np.random.Generator, contexts: Contexts, spread: float
) -> tuple[Contexts, dict[str, float]]:
    """Contexts as their sensors give them, and the standard deviation of each sensor's noise."""
    out, noises = {}, {}
    for name, (mood, size) in structure.moods.items():
        noise = spread * _ERRORS[mood] * size * float(rng.uniform(0.5, 1.0))
        gain = 1.0 if mood == "air" else 1.0 + 0.25 * spread * _ERRORS[mood] * rng.uniform(-1, 1)
        out[name] = gain * contexts[name] + noise * rng.standard_normal(len(contexts[name]))
        noises[name] = noise
    return out, noises


def _memory(rng: np.random.Generator, days: Array, tau: float) -> Array:
    """Ornstein-Uhlenbeck process of unit variance with a time constant [d], at any steps."""
    out = np.empty(len(days))
    out[0] = rng.standard_normal()
    for k in range(1, len(days)):
        kept = np.exp(-(days[k] - days[k - 1]) / tau)
        out[k] = kept * out[k - 1] + np.sqrt(1.0 - kept**2) * rng.standard_normal()
    return out


def _air(rng: np.random.Generator, days: Array) -> Array:
    """Weather of some days' memory, and days whose afternoons are steeper than their nights."""
    clock = 2.0 * np.pi * (days + rng.random())
    day = np.exp(np.sin(clock)) - 1.27
    level, swing = rng.uniform(0.0, 18.0), float(rng.lognormal(1.2, 0.3))
    return np.asarray(level + 5.0 * _memory(rng, days, 3.0) + swing * day)


def _wind(rng: np.random.Generator, days: Array) -> Array:
    """Pressure in its size: the square of a Weibull speed, from a side that turns slowly."""
    share = np.clip(norm.cdf(_memory(rng, days, 0.15)), 1e-6, 1.0 - 1e-6)
    speed = (-np.log1p(-share)) ** (1.0 / _WEIBULL)
    return np.asarray(speed**2 * np.cos(1.5 * _memory(rng, days, 1.0) + rng.uniform(0.0, 6.28)))


def _snow(rng: np.random.Generator, rows: int) -> Array:
    """Falls at random times, of exponential depth, that melt away."""
    fall = np.where(rng.random(rows) < 8.0 / rows, rng.exponential(0.7, rows), 0.0)
    melt = np.exp(-1.0 / (rng.uniform(0.1, 0.3) * rows))
    out = np.empty(rows)
    left = float(rng.exponential(0.5))
    for k in range(rows):
        left = melt * left + fall[k]
        out[k] = left
    return out
