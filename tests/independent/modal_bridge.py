"""A bridge that swings, by plain NumPy: the truth behind measured modes.

The truth is a frame with stiff joints and scatter in every member; who analyses it holds a truss.
Windows have noise with memory, modes that were not found, and no names.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from independent.dense_modes import dense_mode_shapes
from rga.model import Model, read_model
from rga.records.modal.record import ModalRecord

FloatArray = NDArray[np.float64]
#: a model file with members of the kind that is named
Structure = Callable[[str], dict[str, Any]]
PANELS, PANEL, WIDE, HIGH = 6, 4.0, 4.0, 4.0
#: of a typical member [m2, m4], and its modulus [Pa]
AREA, INERTIA, MODULUS = 4e-3, 6e-6, 2.1e11
DECK = 2500.0
SCATTER, NOISE, MEMORY, SHAPE_NOISE, MISSING = 0.02, 0.002, 0.3, 0.02, 0.1


@dataclass(frozen=True)
class Hidden:
    """What the truth has and the model has not.

    Attributes:
        stiffness: factors on groups of members, from a window on.
        mass: added on nodes [kg], from a window on.
        spring: lateral stiffness of the bearings in place of rigid ones [N/m], by node.
        clock: factor on the frequencies.
        onset: window from which on stiffness and mass act.
    """

    stiffness: dict[str, float] = field(default_factory=dict)
    mass: dict[str, float] = field(default_factory=dict)
    spring: dict[str, float] = field(default_factory=dict)
    clock: float = 1.0
    onset: int = 0


@dataclass(frozen=True)
class Parked:
    """A truck of known mass, which the model has with the mass that is stated.

    Attributes:
        mass: on each of the nodes on which it stands [kg].
        windows: in which it stands there, the first and the one behind the last.
    """

    mass: dict[str, float]
    windows: tuple[int, int]

    def stands(self, window: int) -> bool:
        return self.windows[0] <= window < self.windows[1]


def bridge(kind: str = "truss") -> dict[str, Any]:
    """The bridge as a model file, its members of one kind."""
    nodes: dict[str, list[float]] = {}
    members: dict[str, tuple[str, str, str]] = {}

    def join(first: str, last: str, group: str) -> None:
        members[f"{first}-{last}"] = (first, last, group)

    for side, y in (("n", 0.0), ("s", WIDE)):
        for at in range(PANELS + 1):
            nodes[f"b{at}{side}"] = [at * PANEL, y, 0.0]
        for at in range(1, PANELS):
            nodes[f"t{at}{side}"] = [at * PANEL, y, HIGH]
        for at in range(PANELS):
            join(f"b{at}{side}", f"b{at + 1}{side}", f"bottom {side}")
        for at in range(1, PANELS):
            join(f"b{at}{side}", f"t{at}{side}", f"verticals {side}")
        for at in range(1, PANELS - 1):
            join(f"t{at}{side}", f"t{at + 1}{side}", f"top {side}")
            join(f"b{at}{side}", f"t{at + 1}{side}", f"diagonals {side}")
            join(f"t{at}{side}", f"b{at + 1}{side}", f"diagonals {side}")
        join(f"b0{side}", f"t1{side}", f"end posts {side}")
        join(f"t{PANELS - 1}{side}", f"b{PANELS}{side}", f"end posts {side}")
    for at in range(PANELS + 1):
        join(f"b{at}n", f"b{at}s", "floor beams")
    for at in range(PANELS):
        join(f"b{at}n", f"b{at + 1}s", "bottom bracing")
        join(f"b{at}s", f"b{at + 1}n", "bottom bracing")
    for at in range(1, PANELS):
        join(f"t{at}n", f"t{at}s", "top struts")
        join(f"b{at}n", f"t{at}s", "sway bracing")
        join(f"b{at}s", f"t{at}n", "sway bracing")
    for at in range(1, PANELS - 1):
        join(f"t{at}n", f"t{at + 1}s", "top bracing")
        join(f"t{at}s", f"t{at + 1}n", "top bracing")
    light = {"bottom bracing", "top bracing", "sway bracing"}
    deck = [name for name in nodes if name.startswith("b")]
    return {
        "rga_model": 1,
        "name": "bridge",
        "materials": {"steel": {"E": MODULUS, "nu": 0.3, "density": 7850.0}},
        "sections": {
            name: {"A": area, "Iy": INERTIA, "Iz": INERTIA, "J": INERTIA}
            for name, area in (("main", AREA), ("light", AREA / 4))
        },
        "nodes": nodes,
        "members": {
            name: {
                "nodes": [first, last], "section": "light" if group in light else "main",
                "material": "steel", "kind": kind, "groups": [group],
            }
            for name, (first, last, group) in members.items()
        },
        "supports": {
            "west n": {"node": "b0n", "fixed": ["ux", "uy", "uz"]},
            "west s": {"node": "b0s", "fixed": ["ux", "uy", "uz"]},
            "east n": {"node": f"b{PANELS}n", "fixed": ["uy", "uz"]},
            "east s": {"node": f"b{PANELS}s", "fixed": ["uy", "uz"]},
        },
        "masses": {f"deck {name}": {"node": name, "mass": DECK} for name in deck},
        "points": {
            f"{name} {axis}": {"node": name, "direction": direction}
            for name in nodes
            if name[1] in "135"
            for axis, direction in (("y", [0, 1, 0]), ("z", [0, 0, 1]))
        },
    }  # fmt: skip


def truth(
    rng: np.random.Generator,
    hidden: Hidden,
    late: bool,
    structure: Structure = bridge,
    parked: Parked | None = None,
) -> Model:
    """The frame with its scatter, with what is hidden once it acts, and with what is parked."""
    content = structure("frame")
    for name, member in content["members"].items():
        section = content["sections"][member["section"]]
        factor = float(np.exp(SCATTER * rng.standard_normal()))
        if late:
            factor *= hidden.stiffness.get(member["groups"][0], 1.0)
            factor *= hidden.stiffness.get(name, 1.0)
        # Stiffness alone: what it weighs stays as it is.
        content["materials"][name] = {"E": MODULUS * factor, "nu": 0.3, "density": 7850.0}
        member["material"] = name
        assert section["A"] > 0
    if late:
        for node, mass in hidden.mass.items():
            content["masses"][f"more on {node}"] = {"node": node, "mass": mass}
    for node, mass in parked.mass.items() if parked is not None else ():
        content["masses"][f"parked on {node}"] = {"node": node, "mass": mass}
    content["springs"] = [
        {"node": node, "dof": "uy", "stiffness": stiffness}
        for node, stiffness in hidden.spring.items()
    ]
    for support in content["supports"].values():
        if support["node"] in hidden.spring:
            support["fixed"] = [dof for dof in support["fixed"] if dof != "uy"]
    return read_model(content, "truth")


def park(content: dict[str, Any], parked: Parked) -> None:
    """Add to a model file what is parked on the bridge, as a load that brings its mass."""
    content["context"] = {"truck": {"unit": "-", "range": [0, 1]}}
    content["effects"] = {
        "truck": {
            "kind": "nodal_load",
            "forces": {node: [0, 0, -9.80665 * mass] for node, mass in parked.mass.items()},
            "factor": {"context": "truck"}, "inertia": True,
        }
    }  # fmt: skip


def measured(
    seed: int,
    hidden: Hidden,
    modes: int = 6,
    windows: int = 40,
    structure: Structure = bridge,
    parked: Parked | None = None,
) -> tuple[Model, ModalRecord]:
    """The truss that an analyst holds, and the modes that were found in windows of an hour."""
    content, record = described(seed, hidden, modes, windows, structure, parked)
    return read_model(content, content["name"]), record


def described(
    seed: int,
    hidden: Hidden,
    modes: int = 6,
    windows: int = 40,
    structure: Structure = bridge,
    parked: Parked | None = None,
) -> tuple[dict[str, Any], ModalRecord]:
    """The same with the truss as a model file."""
    rng = np.random.default_rng(seed)
    scatter = np.random.default_rng(seed + 1000)
    content = structure("truss")
    points = list(content["points"])
    nodes = list(content["nodes"])
    states = {}
    for late, stands in product((False, True), (None, *filter(None, [parked]))):
        scatter = np.random.default_rng(seed + 1000)
        built = truth(scatter, hidden, late, structure, stands)
        frequencies, shapes = dense_mode_shapes(built, modes)
        shapes = shapes.reshape(modes, len(nodes), 6)
        at_points = np.array(
            [
                [
                    shape[nodes.index(one["node"])][:3] @ one["direction"]
                    for one in content["points"].values()
                ]
                for shape in shapes
            ]
        )
        states[late, stands is not None] = frequencies * hidden.clock, at_points
    entries: list[tuple[float, float, FloatArray]] = []
    noise = np.zeros(modes)
    for window in range(windows):
        noise = MEMORY * noise + np.sqrt(1 - MEMORY**2) * NOISE * rng.standard_normal(modes)
        stands = parked is not None and parked.stands(window)
        frequencies, shapes = states[window >= hidden.onset, stands]
        for mode in rng.permutation(modes):
            if rng.random() < MISSING:
                continue
            shape = shapes[mode] * rng.choice([-1.0, 1.0]) / np.abs(shapes[mode]).max()
            shape = shape + SHAPE_NOISE * rng.standard_normal(len(points))
            entries.append((3600.0 * window, frequencies[mode] * np.exp(noise[mode]), shape))
    contexts = {}
    if parked is not None:
        there = [parked.stands(round(time / 3600.0)) for time, _, _ in entries]
        contexts["truck"] = np.array(there, dtype=float)
        park(content, parked)
    count = len(entries)
    nothing = np.full(count, np.nan)
    record = ModalRecord(
        time=np.array([time for time, _, _ in entries]),
        start=0.0,
        duration=nothing,
        frequency=np.array([frequency for _, frequency, _ in entries]),
        frequency_sd=nothing,
        damping=nothing,
        points=tuple(points),
        shapes=np.array([shape for _, _, shape in entries]),
        realness=np.ones(count),
        hint=("",) * count,
        contexts=contexts,
        left_out=(),
        sha256="",
    )
    frequencies, shapes = states[False, False]
    content["modes"] = {
        f"m{mode}": {
            "near": float(frequencies[mode]), "within": 0.15,
            "shape": dict(zip(points, shapes[mode].tolist(), strict=True)),
        }
        for mode in range(modes)
    }  # fmt: skip
    content["sensors"] = {
        f"f {name}": {"kind": "frequency", "mode": name, "unit": "Hz"} for name in content["modes"]
    }
    return content, record
