"""What the logger makes of the truth: sensor faults and errors of measured contexts."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts, respond, temperature_change
from rga_bench.synthetic.physics.world import World

_DAY = 86400.0


def observe(world: World, contexts: Contexts, time: Array) -> Array:
    """Channels [n, c] in sensor units, before noise, for true ``contexts`` at ``time`` [s]."""
    reading = respond(world, contexts, time)[0]
    column = {name: k for k, name in enumerate(world.model["sensors"])}
    for op, what in world.sensor_ops:
        if op == "gains":
            reading = reading * what
        elif op == "swap":
            a, b = (column[name] for name in what)
            reading[:, [a, b]] = reading[:, [b, a]]
        else:
            _spoil(reading[:, column[what[0]]], op, what[1], time, world, contexts)
    return reading


def slopes(world: World, contexts: Contexts, time: Array) -> dict[str, Array]:
    """Derivatives of the channels by every context, [n, c] each."""
    found = {}
    for name, variable in world.model["context"].items():
        low, high = variable["range"]
        step = 1e-3 * (high - low)
        ahead = observe(world, {**contexts, name: contexts[name] + step}, time)
        behind = observe(world, {**contexts, name: contexts[name] - step}, time)
        found[name] = (ahead - behind) / (2.0 * step)
    return found


def _spoil(
    channel: Array, op: str, amount: float, time: Array, world: World, contexts: Contexts
) -> None:
    """Change one channel [n] in place."""
    if op == "bias":
        channel += amount
    elif op == "gain":
        channel *= amount
    elif op == "drift":
        channel += amount * (time - time[0]) / _DAY
    elif op == "temperature":
        channel += amount * temperature_change(world, contexts)
    elif op == "dead":
        channel[time >= amount] = 0.0
    elif op == "stuck":
        late = time >= amount
        channel[late] = channel[late][0] if late.any() else 0.0
    else:
        raise ValueError(f"no such fault: {op}")


def silenced(world: World, time: Array) -> dict[int, tuple[str, int]]:
    """Channels that stop reading: column -> (mode, first row)."""
    column = {name: k for k, name in enumerate(world.model["sensors"])}
    return {
        column[what[0]]: (op, int(np.argmax(time >= what[1])))
        for op, what in world.sensor_ops
        if op in ("dead", "stuck")
    }


def measure(world: World, contexts: Contexts) -> Contexts:
    """Contexts as a wrong sensor gives them: true * factor + offset."""
    out = dict(contexts)
    for op, name, amount in world.context_ops:
        out[name] = out[name] * amount if op == "gain" else out[name] + amount
    return out
