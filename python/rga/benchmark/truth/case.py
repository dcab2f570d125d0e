"""Draw a blind case and write it: model.json, record.csv, truth.json."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .as_built import build
from .bridges import BRIDGES
from .contexts import courses, errors
from .draft import Bridge, ModelDict
from .effect import Setting, Span
from .frame import Array
from .gauges import measure, observe, silenced
from .hidden import DRAWN, HIDDEN, KINDS, draw_hidden, fits
from .noise import autoregressive, long_run_variance, missing, stream
from .response import Contexts, respond
from .score import d_prime
from .world import World

_NULLS = 0.2


@dataclass(frozen=True)
class Case:
    """One blind case.

    ``model``: a model file; ``time`` [n] [s]; ``channels``: sensors in their units, then
    measured contexts, each [n], NaN where missing; ``truth``: what was hidden.
    """

    model: ModelDict
    time: Array
    channels: dict[str, Array]
    truth: dict[str, Any]

    def write(self, folder: str | Path) -> None:
        """Write the three files; each appears whole or not at all."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        table = np.column_stack([self.time, *self.channels.values()])
        rows = [",".join("" if np.isnan(x) else f"{x:.9g}" for x in row) for row in table]
        record = "\n".join([",".join(["time", *self.channels]), *rows])
        _replace(folder / "record.csv", record + "\n")
        _replace(folder / "model.json", json.dumps(self.model, indent=1) + "\n")
        _replace(folder / "truth.json", json.dumps(self.truth, indent=1) + "\n")


def _replace(path: Path, text: str) -> None:
    draft = path.with_name(path.name + ".part")
    draft.write_text(text, encoding="utf-8")
    draft.replace(path)


class _Reality(NamedTuple):
    """Everything about a case that does not depend on what is hidden."""

    world: World
    time: Array
    contexts: Contexts
    measured: Contexts
    noise: Array  # [n, c]
    variance: Array  # [c], of the noise that does not average out faster than white noise
    shares: list[Array]
    clean: Array  # [n, c]
    facts: dict[str, Any]


def draw_case(
    seed: int,
    *,
    bridge: str | None = None,
    kind: str | None = None,
    reality: str | None = None,
    rows: int = 300,
) -> Case:
    """A case of ``rows`` samples; what is not asked for is drawn by ``seed``.

    Same seed, same bits. With the same bridge and reality, cases of different kinds share
    scatter, contexts and noise, so that they differ by the hidden effect alone.

    Raises:
        ValueError: an unknown name, or a kind that the bridge or the reality cannot have.
    """
    name, kind, reality = _choose(seed, bridge, kind, reality)
    place = BRIDGES[name](stream(seed, "bridge"))
    base = _reality(seed, place, "truss" if kind == "joint_rigidity" else reality, rows)
    truth = {
        "kind": kind,
        "bridge": name,
        "onset": None,
        "place": {},
        "parameter": None,
        "value": None,
        "reality": reality,
        "d_prime": 0.0,
        **base.facts,
    }
    world, readings = base.world, base.clean
    if kind != "null":
        world, readings = _hide(seed, kind, place, base, truth)
    readings = readings + base.noise
    for column, (mode, first) in silenced(world, base.time).items():
        readings[first:, column] = 0.0 if mode == "dead" else readings[first, column]
    readings[missing(stream(seed, "missing"), *readings.shape)] = np.nan
    channels = {sensor: readings[:, k] for k, sensor in enumerate(place.model["sensors"])}
    channels.update(measure(world, base.measured))
    return Case(place.model, base.time, channels, truth)


def _choose(
    seed: int, bridge: str | None, kind: str | None, reality: str | None
) -> tuple[str, str, str]:
    rng = stream(seed, "choice")
    drawn = list(BRIDGES)[int(rng.integers(len(BRIDGES)))]
    stiff = "frame" if rng.random() < 0.5 else "truss"
    null, order = rng.random() < _NULLS, rng.permutation(len(DRAWN))
    name = bridge or drawn
    if name not in BRIDGES:
        raise ValueError(f"no bridge {name!r}; there are {', '.join(BRIDGES)}")
    if kind is not None and kind not in KINDS:
        raise ValueError(f"no hidden kind {kind!r}; there are {', '.join(KINDS)}")
    if reality not in (None, "truss", "frame"):
        raise ValueError(f"reality is 'truss' or 'frame', not {reality!r}")
    model = BRIDGES[name](stream(seed, "bridge"))
    if kind is not None and not fits(kind, model):
        raise ValueError(f"the bridge {name!r} has nothing that {kind!r} could act on")
    if kind is None:
        hidden = [list(DRAWN)[int(k)] for k in order]
        usable = [k for k in hidden if fits(k, model)]
        if reality == "truss":
            usable.remove("joint_rigidity")
        kind = "null" if null else usable[0]
    if kind == "joint_rigidity":
        if reality == "truss":
            raise ValueError("joint_rigidity is a frame reality")
        return name, kind, "frame"
    return name, kind, reality or stiff


def _reality(seed: int, bridge: Bridge, reality: str, rows: int) -> _Reality:
    built = build(bridge.model, stream(seed, "as built"))
    world = built.world
    time, contexts = courses(bridge, stream(seed, "contexts"), rows)
    measured = errors(bridge, stream(seed, "context errors"), contexts)
    clean = observe(world, contexts, time)
    _, shares = respond(world, contexts, time)
    pinned = clean
    if reality == "frame":
        world.join(bridge.jointed, built.joint)
        clean = observe(world, contexts, time)
    blur = observe(world, measured, time) - clean
    noise = autoregressive(stream(seed, "noise"), rows, built.sd, built.phi)
    variance = long_run_variance(built.sd, built.phi) + (blur**2).mean(axis=0)
    parts = list(shares.values())
    facts = {
        **built.facts,
        "joint_stiffness": built.joint if reality == "frame" else None,
        "reality_d_prime": d_prime(clean - pinned, parts, variance),
    }
    return _Reality(world, time, contexts, measured, noise, variance, parts, clean, facts)


def _hide(
    seed: int, kind: str, bridge: Bridge, base: _Reality, truth: dict[str, Any]
) -> tuple[World, Array]:
    """The world and the noise-free channels [n, c] with an effect; fills ``truth`` in."""
    sensors = bridge.model["sensors"]
    noise = {name: float(s["noise"]) for name, s in sensors.items()}
    setting = Setting(bridge, float(base.time[-1] - base.time[0]), noise)
    before = observe(base.world, base.measured, base.time)

    def made(span: Span, value: float | None, onset: float | None) -> tuple[World, Array]:
        world = base.world.copy()
        amount = onset if kind == "sensor_fault" else value
        HIDDEN[kind].act(world, span, 0.0 if amount is None else amount)
        after = observe(world, base.contexts, base.time)
        if onset is not None:
            after = np.where(base.time[:, None] >= onset, after, base.clean)
        return world, after

    def size(span: Span, value: float | None, onset: float | None) -> float:
        world, after = made(span, value, onset)
        signature = after - base.clean
        if world.context_ops:
            signature = observe(base.world, measure(world, base.measured), base.time) - before
        return d_prime(signature, base.shares, base.variance)

    hidden = draw_hidden(kind, setting, stream(seed, f"hidden {kind}"), base.time, size)
    span = hidden.span
    truth.update(
        place=span.place,
        parameter=span.parameter or HIDDEN[kind].parameter or None,
        value=hidden.value,
        onset=hidden.onset,
        d_prime=hidden.d_prime,
        **span.fixed,
    )
    if kind == "joint_rigidity":
        truth.update(joint_stiffness=hidden.value, reality_d_prime=hidden.d_prime)
    return made(span, hidden.value, hidden.onset)
