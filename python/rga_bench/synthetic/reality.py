"""A bridge over time, before anything is hidden in it: what all cases of a seed share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rga_bench.synthetic.as_built import build
from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.conditions import Conditions, heavier
from rga_bench.synthetic.contexts import courses, errors
from rga_bench.synthetic.gauges import observe, slopes
from rga_bench.synthetic.hidden.effect import EffectSetting
from rga_bench.synthetic.hidden.observability import Sight
from rga_bench.synthetic.hidden.score import d_prime
from rga_bench.synthetic.noise import long_run_variance, stream
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts, respond
from rga_bench.synthetic.physics.world import World


class Reality(NamedTuple):
    """Everything about a case that does not depend on what is hidden.

    Over the ``rows`` of the record and those after it, [n]: ``time``, ``contexts`` as they are
    and as ``measured``, and the channels ``clean`` [n, c] of noise. ``noise`` [rows, c] is that
    of the record, ``given`` [c] says which sensors are in it, ``latent`` which contexts are
    not. ``size`` gives the d' of a change of the given sensors' channels [rows, given].
    """

    bridge: Bridge
    world: World
    rows: int
    time: Array
    contexts: Contexts
    measured: Contexts
    noise: Array
    clean: Array
    given: np.ndarray
    latent: frozenset[str]
    size: Callable[[Array], float]
    facts: dict[str, Any]

    def setting(self) -> EffectSetting:
        """What an effect is drawn for."""
        sensors = zip(self.bridge.model["sensors"].items(), self.given, strict=True)
        noise = {name: float(sensor["noise"]) for (name, sensor), given in sensors if given}
        within = self.time[: self.rows]
        return EffectSetting(self.bridge, float(within[-1] - within[0]), noise, self.latent)


def realise(seed: int, bridge: Bridge, stiff: bool, rows: int, conditions: Conditions) -> Reality:
    """The reality of a seed; ``stiff``: its joints are, though the model's are pinned."""
    conditions.state_noise(bridge)
    built = build(bridge.model, stream(seed, "as built"), given=conditions.scatter)
    world, phi = built.world, conditions.memory(built.phi)
    grid = conditions.grid(rows)
    kept = conditions.kept(stream(seed, "sampling"), rows)
    even, everywhere = courses(bridge, stream(seed, "contexts"), grid)
    healthy = errors(bridge, stream(seed, "context errors"), everywhere, conditions.error)
    time, contexts, measured = even[kept], _rows(everywhere, kept), _rows(healthy, kept)
    clean = observe(world, contexts, time)
    _, shares = respond(world, contexts, time)
    pinned = clean
    if stiff:
        world.join(bridge.jointed, built.joint)
        clean = observe(world, contexts, time)
    noise = conditions.readings_noise(stream(seed, "noise"), grid, built.sd, phi)[kept]
    latent = conditions.latent(stream(seed, "latent"), bridge)
    given = _given(stream(seed, "unseen"), len(bridge.model["sensors"]), conditions.unseen)
    parts = [of_given(share, given) for share in shares.values()]
    steady = long_run_variance(built.sd, phi)[given]
    if latent:
        spread = {name: float(np.std(measured[name] - contexts[name])) for name in contexts}
        sight = _sight(world, contexts, time, given, parts, steady, spread, latent)
        size = sight.d_prime
    else:
        blur = of_given(observe(world, measured, time) - clean, given)
        variance = steady + (blur**2).mean(axis=0)

        def size(signature: Array) -> float:
            return d_prime(signature, parts, variance)

    facts = {
        **built.facts,
        "noise_memory": [float(p) for p in phi],
        "joint_stiffness": built.joint if stiff else None,
        "reality_d_prime": size(of_given(clean - pinned, given)),
    }
    if conditions.later:
        time, contexts, measured = _prolonged(
            bridge, stream(seed, "later contexts"), (time, contexts, measured), conditions.later
        )
        clean = observe(world, contexts, time)
    return Reality(
        bridge, world, rows, time, contexts, measured, noise, clean, given, latent, size, facts
    )


def of_given(channels: Array, given: np.ndarray) -> Array:
    """The channels [n, c] that are given, in the same layout: sums over them keep their bits."""
    return np.compress(given, channels, axis=1)


def _rows(contexts: Contexts, kept: np.ndarray) -> Contexts:
    return {name: course[kept] for name, course in contexts.items()}


def _given(rng: np.random.Generator, sensors: int, unseen: float) -> np.ndarray:
    given = np.ones(sensors, dtype=bool)
    given[rng.choice(sensors, round(unseen * sensors), replace=False)] = False
    return given


def _prolonged(
    bridge: Bridge,
    rng: np.random.Generator,
    record: tuple[Array, Contexts, Contexts],
    later: int,
) -> tuple[Array, Contexts, Contexts]:
    """The time and the contexts, as they are and as measured, with the rows after the record."""
    time, contexts, measured = record
    clock, unlike = courses(bridge, rng, later + 1)
    unlike = {name: course[1:] for name, course in heavier(bridge, unlike).items()}
    after = time[-1] + clock[1:]
    return (
        np.concatenate([time, after]),
        {name: np.concatenate([course, unlike[name]]) for name, course in contexts.items()},
        {name: np.concatenate([course, unlike[name]]) for name, course in measured.items()},
    )


def _sight(
    world: World,
    contexts: Contexts,
    time: Array,
    given: np.ndarray,
    shares: list[Array],
    variance: Array,
    errors_sd: dict[str, float],
    latent: frozenset[str],
) -> Sight:
    """What the given channels can see where a context was not measured."""
    context = world.model["context"]
    derivatives = [of_given(one, given) for one in slopes(world, contexts, time).values()]
    spread = [
        float(np.ptp(context[name]["range"])) / np.sqrt(12.0) if name in latent else errors_sd[name]
        for name in context
    ]
    return Sight(np.stack(derivatives, axis=2), np.array(spread), shares, variance)
