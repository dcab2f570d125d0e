"""Channels of a reality under its contexts, with whatever is hidden in it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rga_bench.field.logger import Logger
from rga_bench.field.solver import Array
from rga_bench.field.world import Contexts, FieldWorld, amplitudes, influence, warmth

_DAY = 86400.0


class FieldSite(NamedTuple):
    """What all realities of a case share: time [n] [s], true contexts, and the logger."""

    time: Array
    contexts: Contexts
    logger: Logger


def respond(world: FieldWorld, contexts: Contexts) -> Array:
    """Channels [n, c] of the structure alone; strange ones only with some amount."""
    amounts = amplitudes(world, contexts)
    if world.strange is None:
        return amounts @ influence(world)
    variant, what, size = world.strange
    if variant == "hysteresis":
        column, half = what
        lag = _play(amounts[:, column], half * np.ptp(amounts[:, column]))
        amounts[:, column] += size * (lag - amounts[:, column])
    elif variant == "softening":
        course = amounts[:, what]
        amounts[:, what] = course * (1.0 + size * np.abs(course) / np.abs(course).max())
    elif variant == "jamming":
        dof, stuck = what
        return _jammed(world, amounts, dof, stuck, size)
    channels = amounts @ influence(world)
    if variant == "cross-talk":
        from_, to = what
        channels[:, to] = channels[:, to] + size * channels[:, from_]
    elif variant == "datum":
        columns, course = what
        channels[:, columns] += size * course[: len(channels), None]
    elif variant == "hidden driver":
        members, course = what
        other = world.copy()
        other.strange = None
        channels = channels + size * np.outer(course[: len(channels)], _swelling(other, members))
    return channels


def observe(world: FieldWorld, site: FieldSite) -> Array:
    """Readings [n, c] before noise."""
    kelvin = warmth(world, site.contexts)
    out = site.logger.read(respond(world, site.contexts), kelvin - kelvin.mean())
    for op, what in world.ops:
        if op == "swap":
            a, b = what
            out[:, [a, b]] = out[:, [b, a]]
            continue
        column, amount, onset = what
        if op == "gain":
            out[:, column] *= amount
        elif op == "bias":
            out[:, column] += amount
        else:
            since = np.maximum(site.time - (site.time[0] if onset is None else onset), 0.0)
            out[:, column] += amount * since / _DAY
    return out


def _play(course: Array, width: float) -> Array:
    """The play operator of hysteresis: follows at a distance of half of ``width``, [n]."""
    out = np.empty_like(course)
    last = course[0]
    for k, now in enumerate(course):
        last = min(max(last, now - 0.5 * width), now + 0.5 * width)
        out[k] = last
    return out


def _jammed(world: FieldWorld, amounts: Array, dof: int, stuck: Array, size: float) -> Array:
    """A bearing that holds what it is at while it is stuck, [n, c]; ``size`` is its stiffness."""
    free = world.copy()
    free.strange = None
    held = free.copy()
    held.springs[dof] = held.springs.get(dof, 0.0) + size
    freely, firmly = amounts @ influence(free), amounts @ influence(held)
    out = freely.copy()
    for k in range(1, len(out)):
        if stuck[k]:
            out[k] = out[k - 1] + firmly[k] - firmly[k - 1]
    return out


def _swelling(world: FieldWorld, members: Array) -> Array:
    """Channels [c] where some members would grow as by one kelvin."""
    groups = world.structure.model["effects"]["warmth"]["groups"]
    own = [sum(groups.get(g, 0.0) for g in m["groups"])
           for m in world.structure.model["members"].values()]  # fmt: skip
    kept = world.bars.alpha
    # The pattern of warmth has the members' kelvin in it: alpha makes it that of the swelling.
    world.bars.alpha = np.where(members, 1.2e-5, 0.0) / np.where(np.array(own) > 0, own, 1.0)
    swollen = influence(world)[0]
    world.bars.alpha = kept
    return np.asarray(swollen)
