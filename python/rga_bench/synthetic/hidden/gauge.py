"""Hidden effects in sensors and in the measurement of contexts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rga_bench.synthetic.hidden.effect import EffectSetting, Kind, Span, either, pick, signed
from rga_bench.synthetic.physics.world import World

Rng = np.random.Generator
_DAY = 86400.0


def _sensor(s: EffectSetting, rng: Rng) -> str:
    return str(pick(rng, list(s.noise)))


def _biased(s: EffectSetting, rng: Rng) -> Span:
    name = _sensor(s, rng)
    mild, severe = signed(rng, 0.5, 12.0)
    return Span({"sensor": name}, mild * s.noise[name], severe * s.noise[name])


def _scaled(s: EffectSetting, rng: Rng) -> Span:
    name = _sensor(s, rng)
    if rng.random() < 0.15:
        return Span({"sensor": name}, -1.0, -1.0)
    return Span({"sensor": name}, *either(rng, (0.92, 0.3), (1.08, 2.0)))


def _drifting(s: EffectSetting, rng: Rng) -> Span:
    name = _sensor(s, rng)
    mild, severe = signed(rng, 1.0, 20.0)
    unit = s.noise[name] / (s.duration / _DAY)
    return Span({"sensor": name}, mild * unit, severe * unit)


def _warming(s: EffectSetting, rng: Rng) -> Span:
    name = _sensor(s, rng)
    mild, severe = signed(rng, 0.03, 1.5)
    return Span({"sensor": name}, mild * s.noise[name], severe * s.noise[name])


def _on_sensor(op: str) -> Callable[[World, Span, float], None]:
    def act(w: World, span: Span, value: float) -> None:
        w.sensor_ops.append((op, (span.place["sensor"], value)))

    return act


def _swapped(s: EffectSetting, rng: Rng) -> Span:
    sensors = s.bridge.model["sensors"]
    alike: list[str] = []
    while not alike:
        # Some sensors are the only ones of their kind that the diagnosis gets.
        first = _sensor(s, rng)
        alike = [n for n in s.noise if n != first and sensors[n]["kind"] == sensors[first]["kind"]]
    return Span({"sensors": [first, pick(rng, alike)]})


def _swap(w: World, span: Span, value: float) -> None:
    w.sensor_ops.append(("swap", tuple(span.place["sensors"])))


def _broken(s: EffectSetting, rng: Rng) -> Span:
    return Span({"sensor": _sensor(s, rng)}, fixed={"mode": pick(rng, ["dead", "stuck"])})


def _break(w: World, span: Span, value: float) -> None:
    """``value`` is the onset here [s]: a stuck channel must know the reading it kept."""
    w.sensor_ops.append((span.fixed["mode"], (span.place["sensor"], value)))


def _measured(s: EffectSetting, role: str) -> bool:
    return role in s.bridge.roles and s.bridge.roles[role] not in s.latent


def _misread(s: EffectSetting, rng: Rng) -> Span:
    roles = s.bridge.roles
    role = pick(rng, [r for r in ("temperature", "area", "position") if _measured(s, r)])
    if role == "temperature":
        return Span({"context": roles[role]}, *signed(rng, 0.3, 10.0))
    if role == "position":
        return Span({"context": roles[role]}, *signed(rng, 0.05, 4.0))
    return Span({"context": roles[role]}, 0.01 * s.bridge.peaks[role], 0.3 * s.bridge.peaks[role])


def _misscaled(s: EffectSetting, rng: Rng) -> Span:
    roles = s.bridge.roles
    role = pick(rng, [r for r in ("temperature", "area", "weight") if _measured(s, r)])
    return Span({"context": roles[role]}, *either(rng, (0.96, 0.5), (1.04, 1.8)))


def _on_context(op: str) -> Callable[[World, Span, float], None]:
    def act(w: World, span: Span, value: float) -> None:
        w.context_ops.append((op, span.place["context"], value))

    return act


GAUGE = {
    "sensor_bias": Kind("offset", _biased, _on_sensor("bias"), onset=0.7, neutral=0.0),
    "sensor_gain": Kind("factor", _scaled, _on_sensor("gain"), onset=0.3, neutral=1.0),
    "sensor_drift": Kind("rate", _drifting, _on_sensor("drift")),
    "sensor_swap": Kind("", _swapped, _swap),
    "sensor_fault": Kind("", _broken, _break, onset=1.0),
    "sensor_temperature": Kind("rate", _warming, _on_sensor("temperature")),
    "context_bias": Kind("offset", _misread, _on_context("bias")),
    "context_gain": Kind("factor", _misscaled, _on_context("gain")),
}
