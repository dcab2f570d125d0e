"""What a campaign of measurements finds of modes, window by window."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure
from rga_bench.swinging.vibration import Vibrations
from rga_bench.synthetic.bridges.model_draft import ModelDict
from rga_bench.synthetic.noise import autoregressive

#: windows whose mean is what is expected of a mode
_FIRST = 10
#: share of a frequency by which a mode may differ from what is expected
_WITHIN = 0.15
#: largest number of points, and share of the nodes that have them
_POINTS, _MEASURED = 24, (0.5, 1.0)
#: of one window: scatter of frequencies as a share of them, and noise of shapes over their largest
_SCATTER, _SHAPE_NOISE = (0.001, 0.004), (0.01, 0.03)
#: what a kelvin takes off a frequency as a share of it, above and below freezing
_WARMTH, _FROST = 2e-4, 1.5e-3
_DAY = 86400.0
AXES = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}


@dataclass(frozen=True)
class Campaign:
    """How modes were measured.

    Attributes:
        windows: how many.
        memory: correlation of the errors of one window and the next [-].
        missing: share of the windows in which a mode is not found.
        swapped: share of the windows in which two modes have each other's shape.
        weather: frequencies follow the air, and by more below freezing.
        clock: factor on all frequencies, from the beginning.
    """

    windows: int = 40
    memory: float = 0.3
    missing: float = 0.1
    swapped: float = 0.0
    weather: bool = False
    clock: float = 1.0


@dataclass(frozen=True)
class Instruments:
    """Where shapes are measured, and how well; ``at``: node and axis of every point [p]."""

    points: ModelDict
    at: list[tuple[int, int]]
    scatter: Array
    shape_noise: float

    def look(self, shapes: Array) -> Array:
        """Shapes [..., nodes, 3] at the points, [..., p]."""
        nodes, axes = np.array(self.at).T
        return np.asarray(shapes[..., nodes, axes])


def instruments(structure: FieldStructure, modes: int, rng: np.random.Generator) -> Instruments:
    """Accelerometers on some of the nodes that can move."""
    model = structure.model
    axes = [0, 2] if model.get("plane") == "xz" else [0, 1, 2]
    held = {one["node"] for one in model["supports"].values()}
    names = [name for name in model["nodes"] if name not in held]
    many = min(round(rng.uniform(*_MEASURED) * len(names)), _POINTS // len(axes))
    chosen = sorted(rng.choice(len(names), many, replace=False).tolist())
    points: dict[str, Any] = {}
    at = []
    for node in (names[k] for k in chosen):
        for axis in axes:
            name = "xyz"[axis]
            points[f"{node} {name}"] = {"node": node, "direction": AXES[name]}
            at.append((list(model["nodes"]).index(node), axis))
    low, high = np.log(_SCATTER)
    scatter = np.exp(rng.uniform(low, high, modes))
    return Instruments(points, at, scatter, float(rng.uniform(*_SHAPE_NOISE)))


def expected(
    vibrations: Vibrations, instruments: Instruments, rng: np.random.Generator
) -> dict[str, Any]:
    """What the first windows showed of every mode, as a model states it."""
    modes = {}
    for k, (frequency, shape) in enumerate(
        zip(vibrations.frequencies, instruments.look(vibrations.shapes), strict=True)
    ):
        error = instruments.scatter[k] / np.sqrt(_FIRST) * rng.standard_normal()
        noise = instruments.shape_noise * np.abs(shape).max() / np.sqrt(_FIRST)
        shape = shape + noise * rng.standard_normal(len(shape))
        modes[f"m{k + 1}"] = {
            "near": round(float(frequency * np.exp(error)), 6),
            "within": _WITHIN,
            "shape": {
                name: round(float(x), 5) for name, x in zip(instruments.points, shape, strict=True)
            },
        }
    return modes


@dataclass(frozen=True)
class Entries:
    """The lines of a modal record.

    ``window``, ``mode`` [n]: of each; ``frequency`` [n] [Hz]; ``shapes`` [n, p];
    ``air`` [windows] [degC] or None.
    """

    window: np.ndarray
    mode: np.ndarray
    frequency: Array
    shapes: Array
    air: Array | None

    def text(self, time: Array, points: list[str]) -> str:
        """The long table (CSV), at the times of the windows [s]."""
        head = ["time", "f", *points] + ([] if self.air is None else ["air"])
        lines = [",".join(head)]
        for window, frequency, shape in zip(self.window, self.frequency, self.shapes, strict=True):
            cells = [time[window], frequency, *shape]
            cells += [] if self.air is None else [self.air[window]]
            lines.append(",".join(f"{x:.9g}" for x in cells))
        return "\n".join(lines) + "\n"


def entries(
    campaign: Campaign,
    states: list[Vibrations],
    late: np.ndarray,
    time: Array,
    instruments: Instruments,
    rng: np.random.Generator,
) -> Entries:
    """What is found in windows; `states` before and after, ``late`` [windows] which of them."""
    count, modes = campaign.windows, len(states[0].frequencies)
    noise = autoregressive(rng, count, instruments.scatter, np.full(modes, campaign.memory))
    air = None
    if campaign.weather:
        days = time / _DAY
        air = 4.0 + 9.0 * np.sin(2.0 * np.pi * days / np.ptp(days)) + 3.0 * np.sin(6.28 * days)
        own = rng.uniform(0.7, 1.3, modes)
        noise = noise - np.outer(_WARMTH * air + _FROST * np.minimum(air, 0.0), own)
    shapes = [instruments.look(one.shapes) for one in states]
    out: list[tuple[int, int, float, Array]] = []
    for window in range(count):
        state = int(late[window])
        found = [int(k) for k in rng.permutation(modes) if rng.random() >= campaign.missing]
        looks = dict(zip(found, found, strict=True))
        if len(found) > 1 and rng.random() < campaign.swapped:
            one, other = found[:2]
            looks |= {one: other, other: one}
        for mode in found:
            shape = shapes[state][looks[mode]]
            noisy = instruments.shape_noise * np.abs(shape).max() * rng.standard_normal(len(shape))
            scale = float(rng.choice([-1.0, 1.0]) * np.exp(rng.uniform(-1.0, 1.0)))
            frequency = campaign.clock * states[state].frequencies[mode]
            out.append((window, mode, frequency * np.exp(noise[window, mode]),
                        scale * (shape + noisy)))  # fmt: skip
    windows, which, frequencies, looked = map(np.array, zip(*out, strict=True))
    return Entries(windows, which, frequencies, looked, air)
