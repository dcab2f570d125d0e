"""What the channels read: load patterns, one solve, then sums over time.

Everything but friction is linear in its coefficients, so a record costs one solve with a
few dozen right-hand sides, whatever its length.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rga_bench.synthetic.physics.clearance import slips, stops
from rga_bench.synthetic.physics.frame import DOFS, Array, Frame, FrameSpring, Solution
from rga_bench.synthetic.physics.friction import slide
from rga_bench.synthetic.physics.world import World

Contexts = dict[str, Array]
_UNIT = {"mm": 1e3, "microstrain": 1e6, "mrad": 1e3}
_TIDE = 44712.0  # [s]
_FLOW = 43200.0  # [s]


@dataclass(frozen=True)
class LoadPattern:
    """A load case of unit size: who drives it, nodal forces [d], member dT [m], settlement [d].

    ``course`` [n] is its size in every row.
    """

    driver: str
    force: Array
    warming: Array
    settlement: Array
    course: Array


def value(parameter: Any, contexts: Contexts, rows: int) -> Array:
    """A parameter of an effect in every row, shape [n]."""
    if isinstance(parameter, dict):
        course = contexts[parameter["context"]] - parameter.get("minus", 0.0)
        return np.asarray(parameter.get("times", 1.0) * course)
    return np.full(rows, float(parameter))


def temperature_change(world: World, contexts: Contexts) -> Array:
    """Delta of the temperature effect in every row [K], shape [n]."""
    rows = len(next(iter(contexts.values())))
    for effect in world.model["effects"].values():
        if effect["kind"] == "temperature":
            return value(effect["delta"], contexts, rows)
    return np.zeros(rows)


def respond(world: World, contexts: Contexts, time: Array) -> tuple[Array, dict[str, Array]]:
    """Noise-free channels [n, c] in sensor units, and the share of each context in them."""
    frame = _assemble(world)
    patterns = _patterns(world, contexts, time)
    sliding = world.friction.dofs if world.friction else []
    units = np.zeros((world.size, len(sliding)))
    units[sliding, np.arange(len(sliding))] = 1.0
    force = np.column_stack([*(p.force for p in patterns), units])
    idle = np.zeros((len(world.alpha), len(sliding)))
    warming = np.column_stack([*(p.warming for p in patterns), idle])
    still = np.zeros((world.size, len(sliding)))
    settlement = np.column_stack([*(p.settlement for p in patterns), still])
    for bar in world.strands:
        push = bar.stiffness * world.geometry.length[bar.member]
        push = push * world.alpha[bar.member] * warming[bar.member]
        force[bar.a] -= push
        force[bar.b] += push
    solution = frame.solve(force, world.alpha[:, None] * warming, settlement)
    gauges = _read(world, solution, warming)
    course = np.column_stack([p.course for p in patterns])
    course = course * _softening(world, patterns)
    if world.friction:
        free = len(patterns)
        grip = slide(world.friction, solution, course, free)
        course = np.hstack([course, grip])
    readings = course @ gauges.T + _played(world, frame, solution, course, warming)
    shares: dict[str, Array] = {}
    for k, pattern in enumerate(patterns):
        part = course[:, k : k + 1] * gauges[:, k]
        shares[pattern.driver] = shares.get(pattern.driver, 0.0) + part
    return readings, shares


def _played(
    world: World, frame: Frame, solution: Solution, course: Array, warming: Array
) -> Array | float:
    """What slip in joints and stops at bearings add to the channels [n, c]."""
    length = world.geometry.length
    if world.slip is not None:
        m = np.flatnonzero(world.slip)
        long = np.zeros((len(length), len(m)))
        long[m, np.arange(len(m))] = 1.0 / length[m]
        moved = frame.solve(np.zeros((world.size, len(m))), long)
        axial = (frame.ea / length)[m, None]
        free = world.alpha[m, None] * warming[m] * length[m, None]
        unit = axial * (moved.elongation[m] - np.eye(len(m)))
        force = course @ (axial * (solution.elongation[m] - free)).T
        # A gauge on a member reads what stretches the steel, not what its bolts have slipped.
        tight = moved._replace(elongation=moved.elongation - long * length[:, None])
        return slips(force, unit, world.slip[m]) @ _read(world, tight, np.zeros_like(long)).T
    if world.stop is not None:
        at, many = world.stop.dofs, len(world.stop.dofs)
        units = np.zeros((world.size, many))
        units[at, np.arange(many)] = 1.0
        pushed = frame.solve(units, np.zeros((len(length), many)))
        loose = course @ solution.u[at].T
        push = stops(loose, pushed.u[at], world.stop.gap, world.stop.stiffness)
        return push @ _read(world, pushed, np.zeros((len(length), many))).T
    return 0.0


def _assemble(world: World) -> Frame:
    springs = [*world.springs, *(FrameSpring(b.a, b.b, b.stiffness) for b in world.strands)]
    return Frame.build(world.geometry, world.section, world.held, springs, world.extra)


def _patterns(world: World, contexts: Contexts, time: Array) -> list[LoadPattern]:
    rows, size, bars = len(time), world.size, len(world.alpha)
    none, cold, fast = np.zeros(size), np.zeros(bars), np.zeros(size)
    out: list[LoadPattern] = []
    for name, effect in world.model["effects"].items():
        if effect["kind"] == "temperature":
            out.extend(_warmth(world, effect, contexts, rows))
        elif effect["kind"] == "thermal_gradient":
            out.append(_gradient(world, effect, contexts, rows))
        elif effect["kind"] == "nodal_load":
            force = np.zeros(size)
            for node, push in effect["forces"].items():
                first = world.dof(node, "ux")
                force[first : first + len(push)] += _lean(world, name, node) * np.array(push)
            course = world.load_factor.get(name, 1.0) * value(effect["factor"], contexts, rows)
            load = [LoadPattern(effect["factor"]["context"], force, cold, fast, course)]
            out.extend(_leaning(world, name, load, contexts, rows))
        elif effect["kind"] == "axle_load":
            load = _axle(world, name, effect, contexts, rows)
            out.extend(_leaning(world, name, load, contexts, rows))
    if world.settlement:
        moved = np.zeros(size)
        for dof, way in world.settlement.items():
            moved[dof] = way
        out.append(LoadPattern("settlement", none, cold, moved, np.ones(rows)))
    for context, force in world.added_load:
        out.append(
            LoadPattern(
                context, np.pad(force, (0, size - len(force))), cold, fast, contexts[context]
            )
        )
    strange = world.curiosity
    if strange and strange.variant != "softening":
        course = np.sin(2.0 * np.pi * time / _TIDE)
        if strange.variant == "squared temperature":
            course = (temperature_change(world, contexts) / 10.0) ** 2
        elif strange.variant == "hysteresis":
            course = _crept(temperature_change(world, contexts) / 10.0, time)
        force = strange.amount * np.pad(strange.force, (0, size - len(strange.force)))
        out.append(LoadPattern("strange", force, cold, fast, course))
    return out


def _crept(warm: Array, time: Array) -> Array:
    """A state that flows towards warm * |warm|, slower than the days go, shape [n]."""
    towards = warm * np.abs(warm)
    out = np.empty_like(towards)
    out[0] = towards[0]
    for row in range(1, len(out)):
        kept = np.exp(-(time[row] - time[row - 1]) / _FLOW)
        out[row] = kept * out[row - 1] + (1.0 - kept) * towards[row]
    return out


def _warmth(world: World, effect: Any, contexts: Contexts, rows: int) -> list[LoadPattern]:
    none = np.zeros(world.size)
    delta = value(effect["delta"], contexts, rows)
    driver = effect["delta"]["context"]
    uniform = np.zeros(len(world.alpha))
    for group, factor in effect["groups"].items():
        uniform[world.members_of(group=group)] = factor
    out = [LoadPattern(driver, none, uniform, none, delta)]
    for axis, (ratio, difference) in world.gradient.items():
        shape = _slope(world, axis)
        out.append(LoadPattern(driver, none, shape, none, ratio * delta + difference))
    return out


def _gradient(world: World, effect: Any, contexts: Contexts, rows: int) -> LoadPattern:
    """A gradient that the model has, driven by a context."""
    none = np.zeros(world.size)
    course = value(effect["difference"], contexts, rows)
    shape = _slope(world, effect["axis"])
    return LoadPattern(effect["difference"]["context"], none, shape, none, course)


def _slope(world: World, axis: str) -> Array:
    """Members' share of a unit difference of temperature over the height or the width [m]."""
    along = world.geometry.xyz[:, 2 if axis == "vertical" else 1]
    middle = along[world.geometry.ends].mean(axis=1)
    return np.asarray((middle - (along.max() + along.min()) / 2.0) / (along.max() - along.min()))


def _leaning(
    world: World, load: str, upright: list[LoadPattern], contexts: Contexts, rows: int
) -> list[LoadPattern]:
    """The patterns of a load, and those that eccentricities in the model add to them."""
    out = list(upright)
    for effect in world.model["effects"].values():
        if effect["kind"] == "load_eccentricity" and load in np.atleast_1d(effect["effect"]):
            side = np.zeros(world.size)
            for k, node in enumerate(world.model["nodes"]):
                side[6 * k : 6 * k + 6] = _side(world, node)
            share = 2.0 * value(effect["share"], contexts, rows)
            driver = effect["share"]["context"]
            out += (
                replace(p, driver=driver, force=side * p.force, course=share * p.course)
                for p in upright
            )
    return out


def _lean(world: World, effect: str, node: str) -> float:
    share = world.load_share.get(effect, 0.0)
    return float(1.0 + 2.0 * share * _side(world, node))


def _side(world: World, node: str) -> float:
    """1 at +y nodes, -1 at -y nodes."""
    across = world.geometry.xyz[:, 1]
    offset = world.model["nodes"][node][1] - (across.max() + across.min()) / 2.0
    return float(np.sign(offset))


def _axle(world: World, name: str, effect: Any, contexts: Contexts, rows: int) -> list[LoadPattern]:
    path = effect["path"]
    points = np.array([world.model["nodes"][n] for n in path])
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    where = value(effect["position"], contexts, rows) + world.load_shift.get(name, 0.0)
    weight = world.load_factor.get(name, 1.0) * value(effect["factor"], contexts, rows)
    idle, cold = np.zeros(world.size), np.zeros(len(world.alpha))
    out = []
    for k, node in enumerate(path):
        course = np.zeros(rows)
        hat = np.eye(len(path))[k]
        for force, offset in zip(effect["forces"], effect["offsets"], strict=True):
            at = where - offset
            course += force * np.interp(at, arc, hat, left=0.0, right=0.0)
        down = idle.copy()
        down[world.dof(node, "uz")] = -_lean(world, name, node)
        out.append(LoadPattern(effect["factor"]["context"], down, cold, idle, course * weight))
    return out


def _softening(world: World, patterns: list[LoadPattern]) -> Array:
    """Factor on each pattern's course [n, p]: joints that yield more the heavier the load."""
    factor = np.ones((len(patterns[0].course), len(patterns)))
    strange = world.curiosity
    if strange is None or strange.variant != "softening":
        return factor
    for k, pattern in enumerate(patterns):
        if np.any(pattern.force):
            level = np.abs(pattern.course)
            level = level / max(float(level.max()), 1e-12)
            factor[:, k] += strange.amount * level**2
    return factor


def _read(world: World, solution: Solution, warming: Array) -> Array:
    """Channels per pattern [c, p] in sensor units."""
    names = list(world.model["members"])
    out = []
    for sensor in world.model["sensors"].values():
        scale = _UNIT[sensor["unit"]]
        if sensor["kind"] == "strain":
            m = names.index(sensor["member"])
            strain = solution.elongation[m] / world.geometry.length[m]
            out.append(scale * (strain - world.alpha[m] * warming[m]))
        else:
            first = world.dof(sensor["node"], DOFS[3 if sensor["kind"] == "rotation" else 0])
            out.append(
                scale * (np.array(sensor["direction"], float) @ solution.u[first : first + 3])
            )
    return np.array(out)
