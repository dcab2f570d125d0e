"""Draw the stream of the case study: ordinary days, an operational drift, a structural effect."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from rga_bench.synthetic.as_built import build
from rga_bench.synthetic.bridges.case_study import case_study_bridge
from rga_bench.synthetic.bridges.model_draft import Bridge
from rga_bench.synthetic.case import Case
from rga_bench.synthetic.gauges import observe, slopes
from rga_bench.synthetic.hidden.catalogue import HIDDEN, sized
from rga_bench.synthetic.hidden.effect import EffectSetting, Span
from rga_bench.synthetic.hidden.observability import Sight
from rga_bench.synthetic.noise import autoregressive, long_run_variance, missing, stream
from rga_bench.synthetic.operation import event, ordinary
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts, respond
from rga_bench.synthetic.physics.world import World

STREAM_KINDS = (
    "member_stiffness",
    "support_spring",
    "support_flexibility",
    "support_settlement",
)
_STEP = 600.0  # [s]
_LEAST_ROWS = 60
_AIM = (30.0, 80.0)  # of d'
_JOINTS = (4.0, 5.0)  # log10 of [N m/rad]: what they change stays within the as-built scatter


class _Reality(NamedTuple):
    """The bridge over time, before anything is hidden in it."""

    bridge: Bridge
    world: World
    time: Array
    contexts: Contexts
    clean: Array  # [n, c], without noise
    sight: Sight


def draw_stream(
    seed: int,
    *,
    hidden: str | None = "drawn",
    drift: bool = True,
    slow: bool = False,
    rows: int = 480,
) -> Case:
    """A stream of ``rows`` records, ten minutes apart, of the bridge of the case study.

    From about 40 % to 60 % of the rows an event is on that no ordinary day has (``drift``), or it
    comes on from there to the last row (``slow``); from about 70 % on, an effect of a kind in
    ``STREAM_KINDS`` is there to stay (``hidden``: the kind, "drawn" by the seed, or None). Of the
    contexts only the temperature is measured. Streams of one seed share their bridge, ordinary
    days and noise, whatever else is in them.

    ``truth`` has the keys of a case and two more. ``drift`` is None, or holds the times ``from``
    and ``until`` [s] of the event's first and last row, the ranges ``novel`` that the contexts had
    in its full swing and ``ordinary`` those of all other days; ``contexts`` holds the true
    courses. ``d_prime`` is that of ``observability.py``.

    Same seed, same bits, for any number of threads.

    Raises:
        ValueError: an unknown kind, or fewer than 60 rows.
    """
    kind = _kind(seed, hidden)
    if rows < _LEAST_ROWS:
        raise ValueError(f"{rows} rows are no stream: give {_LEAST_ROWS} or more")
    with threadpool_limits(1):  # BLAS sums in another order where it has more threads
        bridge = case_study_bridge()
        built = build(bridge.model, stream(seed, "as built"), _JOINTS)
        time = np.asarray(_STEP * np.arange(rows), dtype=np.float64)
        contexts = ordinary(stream(seed, "contexts"), time)
        on = None
        if drift:
            contexts, on = event(stream(seed, "event"), contexts, slow)
        world = built.world.copy()
        world.join(bridge.jointed, built.joint)
        clean = observe(world, contexts, time)
        sight = _sight(world, contexts, time, long_run_variance(built.sd, built.phi))
        truth: dict[str, Any] = {
            "kind": kind or "null",
            "bridge": bridge.name,
            "onset": None,
            "place": {},
            "parameter": None,
            "value": None,
            "reality": "frame",
            "d_prime": 0.0,
            **built.facts,
            "joint_stiffness": built.joint,
            "reality_d_prime": sight.d_prime(clean - observe(built.world, contexts, time)),
            "drift": None if on is None else _drift(time, contexts, on),
            "contexts": {name: [float(x) for x in course] for name, course in contexts.items()},
        }
        readings = clean
        if kind is not None:
            reality = _Reality(bridge, world, time, contexts, clean, sight)
            readings = _hide(kind, reality, stream(seed, f"hidden {kind}"), truth)
    readings = readings + autoregressive(stream(seed, "noise"), rows, built.sd, built.phi)
    readings[missing(stream(seed, "missing"), *readings.shape)] = np.nan
    channels = {sensor: readings[:, k] for k, sensor in enumerate(bridge.model["sensors"])}
    error = stream(seed, "context errors").standard_normal(rows)
    sd = bridge.model["context"]["temperature"]["noise"]
    channels["temperature"] = contexts["temperature"] + sd * error
    return Case(bridge.model, time, channels, truth)


def _kind(seed: int, hidden: str | None) -> str | None:
    if hidden == "drawn":
        return STREAM_KINDS[int(stream(seed, "stream kind").integers(len(STREAM_KINDS)))]
    if hidden is not None and hidden not in STREAM_KINDS:
        raise ValueError(f"no kind {hidden!r} in a stream; there are {', '.join(STREAM_KINDS)}")
    return hidden


def _drift(time: Array, contexts: Contexts, weight: Array) -> dict[str, Any]:
    def ranges(chosen: NDArray[np.bool_]) -> dict[str, list[float]]:
        courses = {name: course[chosen] for name, course in contexts.items()}
        return {name: [float(c.min()), float(c.max())] for name, c in courses.items()}

    within = time[weight > 0.0]
    return {
        "from": float(within[0]),
        "until": float(within[-1]),
        "novel": ranges(weight == 1.0),
        "ordinary": ranges(weight == 0.0),
    }


def _sight(world: World, contexts: Contexts, time: Array, variance: Array) -> Sight:
    spread = [
        variable.get("noise", float(np.ptp(variable["range"])) / np.sqrt(12.0))
        for variable in world.model["context"].values()
    ]
    derivatives = list(slopes(world, contexts, time).values())
    shares = list(respond(world, contexts, time)[1].values())
    return Sight(np.stack(derivatives, axis=2), np.array(spread), shares, variance)


def _hide(kind: str, reality: _Reality, rng: np.random.Generator, truth: dict[str, Any]) -> Array:
    """The noise-free channels [n, c] with an effect; fills ``truth`` in."""
    bridge, world, time, contexts, clean, sight = reality
    onset = float(time[int(rng.uniform(0.68, 0.74) * len(time))])
    aim = float(np.exp(rng.uniform(*np.log(_AIM))))

    def made(span: Span, value: float | None) -> Array:
        other = world.copy()
        HIDDEN[kind].act(other, span, 0.0 if value is None else value)
        return np.where(time[:, None] >= onset, observe(other, contexts, time), clean)

    def size(span: Span, value: float | None, _: float | None) -> float:
        return sight.d_prime(made(span, value) - clean)

    noise = {name: float(sensor["noise"]) for name, sensor in bridge.model["sensors"].items()}
    setting = EffectSetting(bridge, float(time[-1]), noise)
    hidden = sized(kind, setting, rng, onset, aim, size, visible=aim)
    truth.update(
        place=hidden.span.place,
        parameter=HIDDEN[kind].parameter,
        value=hidden.value,
        onset=onset,
        d_prime=hidden.d_prime,
    )
    return made(hidden.span, hidden.value)
