"""The courses of the contexts over time, as they are and as they were measured."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.noise import autoregressive
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts

_DAY = 86400.0


def courses(bridge: Bridge, rng: np.random.Generator, rows: int) -> tuple[Array, Contexts]:
    """Time [n] [s] and true contexts, in the order of the model."""
    step = float(rng.choice([1800.0, 3600.0, 7200.0]))
    time = np.asarray(step * np.arange(rows), dtype=np.float64)
    days = time / _DAY
    mean, wave, season = rng.uniform(5, 17), rng.uniform(5, 10), rng.uniform(3, 7)
    phase = rng.uniform(0, 2 * np.pi, 2)
    weather = autoregressive(rng, rows, np.array([1.2]), np.array([0.95]))[:, 0]
    day_wave = wave * np.sin(2 * np.pi * days + phase[0])
    slow_wave = season * np.sin(2 * np.pi * days / 11.0 + phase[1])
    by_role: dict[str, Array] = {"temperature": mean + day_wave + slow_wave + weather}
    busy = 0.22 * (1 + 0.5 * np.sin(2 * np.pi * days + phase[1]))
    crowd = np.minimum(busy * rng.gamma(2.0, 0.5, rows), 1.0)
    by_role["area"] = np.asarray(bridge.peaks["area"] * crowd, dtype=np.float64)
    by_role["area"][rng.random(rows) < 0.15] = 0.0
    if bridge.carts:
        length = bridge.peaks["position"]
        by_role["position"] = rng.uniform(0.08 * length, 0.92 * length, rows)
        by_role["weight"] = np.where(rng.random(rows) < 0.65, bridge.peaks["weight"], 0.0)
    gust = autoregressive(rng, rows, np.array([1.0]), np.array([0.85]))[:, 0]
    by_role["idle"] = 0.25 * bridge.peaks["idle"] * gust**2
    names = {name: role for role, name in bridge.roles.items()}
    return time, {name: by_role[names[name]] for name in bridge.model["context"]}


def errors(
    bridge: Bridge, rng: np.random.Generator, contexts: Contexts, size: float = 1.0
) -> Contexts:
    """The contexts as sensors measure them: white noise; the cart is weighed once.

    ``size`` is that of the errors beside those of healthy sensors.
    """
    out: Contexts = {}
    for role, name in sorted(bridge.roles.items()):
        course = contexts[name]
        draws = rng.standard_normal(len(course))
        level = size * rng.uniform(0.7, 1.3)
        if role == "temperature":
            out[name] = course + 0.3 * level * draws
        elif role == "position":
            out[name] = course + 0.12 * level * draws
        elif role == "weight":
            out[name] = course * (1.0 + 0.005 * size * draws[0])
        else:
            out[name] = np.maximum(course + 0.008 * level * bridge.peaks[role] * draws, 0.0)
    return {name: out[name] for name in contexts}
