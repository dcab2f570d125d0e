"""What is hidden: kinds of the vocabulary, and what no vocabulary has."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rga_bench.field.solver import Array
from rga_bench.field.world import FieldWorld

Place = dict[str, Any]


class FieldSetting(NamedTuple):
    """What a place is drawn for: reality, rows [s], channels without anything hidden [n, c]."""

    world: FieldWorld
    time: Array
    channels: Array


class FieldSpan(NamedTuple):
    """A place, the values between which an effect grows there, and how it acts on a world.

    ``act`` takes the world, the value and the onset [s] or None. ``geometric``: grows by factors.
    """

    place: Place
    mild: float
    severe: float
    act: Callable[[FieldWorld, float, float | None], None]
    geometric: bool = True
    parameter: str = ""

    def at(self, level: float) -> float:
        """The value at a level of 0..1."""
        if not self.geometric:
            return self.mild + level * (self.severe - self.mild)
        return float(self.mild * (self.severe / self.mild) ** level)


class FieldKind(NamedTuple):
    """A kind: how a place is drawn (None: the structure has none), and how often it is late."""

    draw: Callable[[FieldSetting, np.random.Generator], FieldSpan | None]
    late: float = 0.0
    #: shows after an onset only, where all channels were zeroed
    needs_onset: bool = False


def _one(rng: np.random.Generator, several: list[Any]) -> Any:
    return several[int(rng.integers(len(several)))]


def _member(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    name = _one(rng, list(setting.world.structure.model["members"]))

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        bars, k = world.bars, world.member(name)
        for stiff in (bars.ea, bars.ei_y, bars.ei_z, bars.gj):
            stiff[k] *= value

    return FieldSpan({"member": name}, 0.97, 0.25, act, parameter="factor")


def _supports(setting: FieldSetting, held: bool) -> list[tuple[str, str]]:
    """Supports and directions that are held, or free, in which the structure can move."""
    model = setting.world.structure.model
    flat = model.get("plane") == "xz"
    axes = ["ux", "uz", "ry"] if flat else ["ux", "uy", "uz", "rx", "ry"]
    several = []
    for name, one in model["supports"].items():
        turns = {"rx", "ry"} & set(one["fixed"])
        for dof in axes:
            if dof.startswith("r") and not turns:
                continue
            if (dof in one["fixed"]) == held:
                several.append((name, dof))
    return several


def _spring(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan | None:
    several = _supports(setting, held=False)
    if not several:
        return None
    support, dof = _one(rng, several)

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        where = world.support_dof(support, dof)
        world.springs[where] = world.springs.get(where, 0.0) + value

    return FieldSpan({"support": support, "dof": dof}, 3e4, 3e9, act, parameter="stiffness")


def _flexibility(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    support, dof = _one(rng, _supports(setting, held=True))
    # A foundation that turns: between a pin and a fixed end of the columns at hand.
    mild, severe = (3e10, 1e6) if dof.startswith("r") else (1e10, 1e6)

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        where = world.support_dof(support, dof)
        world.held.discard(where)
        world.springs[where] = value

    return FieldSpan({"support": support, "dof": dof}, mild, severe, act, parameter="stiffness")


def _settlement(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    support, dof = _one(rng, _supports(setting, held=True))
    sign = float(rng.choice([-1.0, 1.0]))
    severe = 0.01 if dof.startswith("r") else 0.05

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.settled[world.support_dof(support, dof)] = value

    place = {"support": support, "dof": dof}
    return FieldSpan(place, sign * severe / 1000.0, sign * severe, act, parameter="displacement")


def _load(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    loads = setting.world.structure.loads
    model = setting.world.structure.model
    first = _one(rng, loads)
    driver = model["effects"][first]["factor"]["context"]
    together = [one for one in loads if model["effects"][one]["factor"]["context"] == driver]
    severe = 1.8 if rng.random() < 0.6 else 0.45

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.load_factor |= dict.fromkeys(together, value)

    place = {"effect": together if len(together) > 1 else first}
    return FieldSpan(place, 1.01, severe, act, geometric=False, parameter="factor")


def _gradient(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    points = np.array(list(setting.world.structure.model["nodes"].values()))
    axes = ["vertical", *(["lateral"] if np.ptp(points[:, 1]) > 0 else [])]
    axis, word = _one(rng, axes), _one(rng, ["difference", "ratio"])
    sign = float(rng.choice([-1.0, 1.0]))
    severe = sign * (25.0 if word == "difference" else 1.0)

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.gradient[axis] = (word, value)

    return FieldSpan({"axis": axis}, severe / 1000.0, severe, act, parameter=word)


def _sensor(setting: FieldSetting, rng: np.random.Generator) -> tuple[str, int, float]:
    """A sensor, its column and its noise."""
    sensors = setting.world.structure.model["sensors"]
    column = int(rng.integers(len(sensors)))
    name = list(sensors)[column]
    return name, column, float(sensors[name]["noise"])


def _gain(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    name, column, _ = _sensor(setting, rng)
    severe = float(_one(rng, [1.8, 0.3]))
    mild = 1.01 if severe > 1 else 0.99

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.ops.append(("gain", (column, value, onset)))

    return FieldSpan({"sensor": name}, mild, severe, act, geometric=False, parameter="factor")


def _bias(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    name, column, noise = _sensor(setting, rng)
    sign = float(rng.choice([-1.0, 1.0]))

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.ops.append(("bias", (column, value, onset)))

    return FieldSpan(
        {"sensor": name}, sign * 0.2 * noise, sign * 60.0 * noise, act, parameter="offset"
    )


def _drift(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    name, column, noise = _sensor(setting, rng)
    days = float(np.ptp(setting.time)) / 86400.0
    rate = float(rng.choice([-1.0, 1.0])) * noise / days

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.ops.append(("drift", (column, value, onset)))

    return FieldSpan({"sensor": name}, 0.2 * rate, 200.0 * rate, act, parameter="rate")


def _swap(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    sensors = setting.world.structure.model["sensors"]
    names = list(sensors)
    while True:
        a, b = (int(k) for k in rng.choice(len(names), 2, replace=False))
        if sensors[names[a]]["unit"] == sensors[names[b]]["unit"]:
            break

    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.ops.append(("swap", (a, b)))

    return FieldSpan({"sensors": [names[a], names[b]]}, 1.0, 1.0, act)


def _pattern(setting: FieldSetting, rng: np.random.Generator) -> int:
    """A pattern whose loads move: behind warmth, two gradients and settlement."""
    model = setting.world.structure.model
    columns, first = [], 4
    for effect in model["effects"].values():
        if effect["kind"] == "nodal_load":
            columns.append(first)
            first += 1
        elif effect["kind"] == "axle_load":
            first += len(effect["path"])
    return int(_one(rng, columns))


def _strange(variant: str, what: Any) -> Callable[[FieldWorld, float, float | None], None]:
    def act(world: FieldWorld, value: float, onset: float | None) -> None:
        world.strange = (variant, what, value)

    return act


def _hysteresis(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    """Friction in the joints: the response to a load lags behind it by its own path."""
    what = (_pattern(setting, rng), float(rng.uniform(0.3, 0.6)))
    return FieldSpan({}, 0.02, 1.0, _strange("hysteresis", what))


def _softening(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    """Joints that give way: the response grows faster than its load."""
    return FieldSpan({}, 0.01, 1.5, _strange("softening", _pattern(setting, rng)))


def _cross_talk(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    """Cables without screens: a channel takes a share of its neighbour's signal."""
    from_, to = (int(k) for k in rng.choice(setting.channels.shape[1], 2, replace=False))
    sensors = list(setting.world.structure.model["sensors"].values())
    unit = sensors[to]["noise"] / sensors[from_]["noise"]
    return FieldSpan({}, 0.01 * unit, 3.0 * unit, _strange("cross-talk", (from_, to)))


def _jamming(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan | None:
    """A bearing that sticks for days and lets go."""
    several = _supports(setting, held=False)
    if not several:
        return None
    support, dof = _one(rng, several)
    rows = len(setting.time)
    stuck = np.zeros(rows, dtype=bool)
    for _ in range(int(rng.integers(2, 4))):
        first = int(rng.uniform(0.05, 0.8) * rows)
        stuck[first : first + int(rng.uniform(0.1, 0.25) * rows)] = True
    where = setting.world.support_dof(support, dof)
    return FieldSpan({}, 1e5, 1e10, _strange("jamming", (where, stuck)))


def _driver(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    """Moisture, or a tide: members of a group grow and shrink with what nobody measures."""
    members = setting.world.structure.model["members"].values()
    group = _one(rng, sorted({g for m in members for g in m["groups"]}))
    chosen = np.array([group in m["groups"] for m in members])
    hours = (setting.time - setting.time[0]) / 3600.0
    # Semidiurnal tide of 12.42 h, or the slow beat of the weather's moisture.
    period = 12.42 if rng.random() < 0.5 else float(rng.uniform(0.3, 0.8) * hours[-1])
    course = np.sin(2.0 * np.pi * (hours / period + rng.random()))
    return FieldSpan({}, 0.05, 60.0, _strange("hidden driver", (chosen, course)))


def _datum(setting: FieldSetting, rng: np.random.Generator) -> FieldSpan:
    """The stand that all displacements are measured from moves itself."""
    sensors = setting.world.structure.model["sensors"].values()
    columns = np.array([k for k, one in enumerate(sensors) if one["kind"] == "displacement"])
    walk = np.cumsum(rng.standard_normal(len(setting.time)))
    width = max(3, len(walk) // 12)
    course = np.convolve(np.pad(walk, width, mode="edge"), np.ones(width) / width, "same")
    course = course[width:-width] - course.mean()
    return FieldSpan({}, 0.01, 30.0, _strange("datum", (columns, course / np.abs(course).max())))


INSIDE: dict[str, FieldKind] = {
    "member_stiffness": FieldKind(_member, 0.4),
    "support_spring": FieldKind(_spring, 0.3),
    "support_flexibility": FieldKind(_flexibility, 0.3),
    "support_settlement": FieldKind(_settlement, 0.8, needs_onset=True),
    "load_scale": FieldKind(_load),
    "thermal_gradient": FieldKind(_gradient),
    "sensor_gain": FieldKind(_gain, 0.3),
    "sensor_bias": FieldKind(_bias, 0.6, needs_onset=True),
    "sensor_drift": FieldKind(_drift, 0.4),
    "sensor_swap": FieldKind(_swap),
}
OUTSIDE: dict[str, FieldKind] = {
    "hysteresis": FieldKind(_hysteresis),
    "softening": FieldKind(_softening),
    "cross-talk": FieldKind(_cross_talk),
    "jamming": FieldKind(_jamming),
    "hidden driver": FieldKind(_driver),
    "datum": FieldKind(_datum),
}
KINDS: dict[str, FieldKind] = {**INSIDE, **OUTSIDE}
