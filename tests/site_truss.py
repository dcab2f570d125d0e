"""A truss as a site has it, in plain NumPy: what it is in truth, what its logger writes down.

The physics is this file's own (displacement method, plane members with or without bending), so
that nothing in a record comes from the simulator that is to judge it.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.model import Model, read_model
from rga.records import Record

Array = NDArray[np.float64]
E, AREA, BENDS, ALPHA, PANEL, ROWS = 2e11, 0.004, 8e-6, 1.2e-5, 3.0, 120
#: seconds from row to row
STEP = 3600.0
NODES = {f"L{i}": (PANEL * i, 0.0) for i in range(7)}
NODES |= {f"U{i}": (PANEL * i, PANEL) for i in range(1, 6)}
BARS = {
    "bottom chord": [f"L{i}-L{i + 1}" for i in range(6)],
    "top chord": [f"U{i}-U{i + 1}" for i in range(1, 5)],
    "verticals": [f"L{i}-U{i}" for i in range(1, 6)],
    "diagonals": ["L0-U1", "U1-L2", "U2-L3", "L3-U4", "L4-U5", "U5-L6"],
}
MEMBERS = [bar for bars in BARS.values() for bar in bars]
ENDS = np.array([[list(NODES).index(node) for node in bar.split("-")] for bar in MEMBERS])
GAUGED = ("L0-L1", "L1-L2", "L2-L3", "L3-L4", "U2-U3", "U3-U4", "L0-U1", "U1-L2", "U2-L3", "L3-U3")
MOVED = {"D1": "L1", "D2": "L2", "D3": "L3", "D4": "L4", "D5": "L5"}
#: standard deviations of noise [mm], [microstrain]; what each reads of [m], [-]
NOISE, UNIT = {"mm": 0.05, "microstrain": 1.0}, {"mm": 1e3, "microstrain": 1e6}
#: forces of a kN of either load [N], by node
LOADS = {"west load": {"L1": 1000, "L2": 500}, "east load": {"L4": 500, "L5": 1000}}
SPREAD = {"temperature": 0.2, "west load": 0.1, "east load": 0.1}
#: distance of a gauge from the axis of its member [m]
FIBRE = 0.06


def content(*gauges: str) -> dict[str, Any]:
    """The model file: pinned, as an engineer draws it; of some gauges only, where they are told."""
    moved = {
        name: {"kind": "displacement", "node": node, "direction": [0, 0, 1], "unit": "mm"}
        for name, node in MOVED.items()
    }
    moved["DX"] = {**moved["D1"], "node": "L6", "direction": [1, 0, 0]}
    strained = {
        f"S {bar}": {"kind": "strain", "member": bar, "unit": "microstrain"} for bar in GAUGED
    }
    every = {name: {**one, "noise": NOISE[one["unit"]]} for name, one in (moved | strained).items()}
    return {
        "rga_model": 1,
        "name": "site",
        "plane": "xz",
        "materials": {"steel": {"E": E, "alpha": ALPHA}},
        "sections": {"bar": {"A": AREA}},
        "nodes": {name: [x, 0, z] for name, (x, z) in NODES.items()},
        "members": {
            bar: {"nodes": bar.split("-"), "section": "bar", "material": "steel", "groups": [group]}
            for group, bars in BARS.items()
            for bar in bars
        },
        "supports": {
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": "L6", "fixed": ["uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": SPREAD["temperature"]},
            **{load: {"unit": "kN", "range": [0, 100], "noise": SPREAD[load]} for load in LOADS},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": dict.fromkeys(BARS, 1.0),
                "delta": {"context": "temperature", "minus": 10.0},
            },
            **{
                load: {
                    "kind": "nodal_load",
                    "forces": {node: [0, 0, -force] for node, force in forces.items()},
                    "factor": {"context": load},
                }
                for load, forces in LOADS.items()
            },
        },
        "sensors": {name: every[name] for name in gauges or every},
    }


def model(*gauges: str) -> Model:
    return read_model(content(*gauges), "site")


@dataclass(frozen=True)
class Site:
    """What the truss is in truth; as modelled unless said otherwise.

    Attributes:
        area: factors on EA, by member.
        welded: joints are rigid, and gauges sit at a fibre.
        roller: stiffness of the bearing that should slide [N/m], float[rows].
        sinks: settlement of the east bearing [m], float[rows].
        stretched: strain without stress beside that of the temperature, float[rows, members].
        down: more forces downwards [N] by node, float[rows] each.
        loads: factors on the loads, float[rows] each.
    """

    area: dict[str, float] = field(default_factory=dict)
    welded: bool = False
    roller: Array = field(default_factory=lambda: np.zeros(ROWS))
    sinks: Array = field(default_factory=lambda: np.zeros(ROWS))
    stretched: Array = field(default_factory=lambda: np.zeros((ROWS, len(MEMBERS))))
    down: dict[str, Array] = field(default_factory=dict)
    loads: dict[str, Array] = field(default_factory=dict)

    def readings(self, contexts: dict[str, Array], built: Array) -> dict[str, Array]:
        """What faultless sensors read, float[rows] each.

        Args:
            contexts: true ones.
            built: factors on EA and EI of the members as built.
        """
        xz = np.array(list(NODES.values()))
        along = xz[ENDS[:, 1]] - xz[ENDS[:, 0]]
        length = np.hypot(*along.T)
        cos, sin = (along / length[:, None]).T
        ea = E * AREA * built * [self.area.get(bar, 1.0) for bar in MEMBERS]
        ei = E * BENDS * built * self.welded
        stiff = np.zeros((3 * len(xz), 3 * len(xz)))
        own = np.zeros((len(contexts["temperature"]), len(stiff)))
        warmth = ALPHA * (contexts["temperature"] - 10.0)
        stretch = self.stretched + warmth[:, None]
        dofs, shapes = [], []
        for k in range(len(MEMBERS)):
            dof = np.concatenate([3 * node + np.arange(3) for node in ENDS[k]])
            c, s, span = cos[k], sin[k], length[k]
            # Lengthening, and the turns of both ends against the chord of the member.
            turn = np.array([s, -c, 0, -s, c, 0]) / span
            ends = np.eye(6)[[2, 5]] - turn
            shape = np.vstack([[-c, -s, 0, c, s, 0], ends])
            bend = ei[k] / span * np.array([[4, 2], [2, 4]])
            inner = np.block([[np.array([[ea[k] / span]]), np.zeros((1, 2))],
                              [np.zeros((2, 1)), bend]])  # fmt: skip
            stiff[np.ix_(dof, dof)] += shape.T @ inner @ shape
            own[:, dof] += ea[k] * stretch[:, [k]] * shape[0]
            dofs.append(dof)
            shapes.append(shape)
        index = {name: 3 * k for k, name in enumerate(NODES)}
        for load, forces in LOADS.items():
            factor = contexts[load] * self.loads.get(load, 1.0)
            for node, force in forces.items():
                own[:, index[node] + 1] -= force * factor
        for node, force in self.down.items():
            own[:, index[node] + 1] -= force
        held = [index["L0"], index["L0"] + 1, index["L6"] + 1]
        free = [k for k in range(len(stiff)) if k not in held and (self.welded or k % 3 < 2)]
        u = np.zeros_like(own)
        u[:, held[2]] = -self.sinks
        own -= u @ stiff
        for spring in np.unique(self.roller):
            with_spring = stiff.copy()
            with_spring[index["L6"], index["L6"]] += spring
            rows = np.flatnonzero(self.roller == spring)
            part = np.linalg.solve(with_spring[np.ix_(free, free)], own[np.ix_(rows, free)].T)
            u[np.ix_(rows, free)] = part.T
        shown = {name: u[:, index[node] + 1] * UNIT["mm"] for name, node in MOVED.items()}
        shown["DX"] = u[:, index["L6"]] * UNIT["mm"]
        for bar in GAUGED:
            k = MEMBERS.index(bar)
            longer, first, last = shapes[k] @ u[:, dofs[k]].T
            bent = self.welded * FIBRE * (last - first) / length[k]
            # Gauges that make up for the warmth of their own member.
            strain = longer / length[k] - bent - warmth
            shown[f"S {bar}"] = strain * UNIT["microstrain"]
        return shown


@dataclass(frozen=True)
class Logged:
    """A record before it is written: its columns may still be spoilt.

    Attributes:
        time: [s], float[rows].
        readings: float[rows] each.
        contexts: as measured, float[rows] each.
    """

    time: Array
    readings: dict[str, Array]
    contexts: dict[str, Array]

    def record(self, *gauges: str, zero: tuple[int, int] | None = None) -> Record:
        """The record; all channels set to zero over rows, where their first and end are told."""
        columns = np.column_stack([self.readings[name] for name in gauges or self.readings])
        names = tuple(gauges or self.readings)
        span = None
        if zero is not None:
            columns = columns - columns[slice(*zero)].mean(0)
            span = (float(self.time[zero[0]]), float(self.time[zero[1] - 1]))
        return Record(self.time, 0.0, "seconds", names, columns, dict(self.contexts), zero=span)


def logged(site: Site, seed: int = 1) -> Logged:
    """The site over five days: two loads and a temperature, members 1 % and gauges 0.5 % off."""
    draw = np.random.default_rng(seed)
    time = STEP * np.arange(ROWS)
    contexts = {
        "temperature": 10 + 6 * np.sin(2 * np.pi * time / 86400) + 2 * draw.standard_normal(ROWS),
        "west load": 30 + 12 * np.sin(2 * np.pi * np.arange(ROWS) / 17) + 12 * draw.random(ROWS),
        "east load": 30 + 12 * np.cos(2 * np.pi * np.arange(ROWS) / 29) + 12 * draw.random(ROWS),
    }
    built = np.exp(0.01 * draw.standard_normal(len(MEMBERS)))
    readings = site.readings(contexts, built)
    for name, column in readings.items():
        noise = NOISE["microstrain" if name.startswith("S ") else "mm"]
        gain = 1 + 0.005 * draw.standard_normal()
        readings[name] = column * gain + noise * draw.standard_normal(ROWS)
    for name, column in contexts.items():
        contexts[name] = column + SPREAD[name] * draw.standard_normal(ROWS)
    return Logged(time, readings, contexts)
