"""The physical twin of the full case study: a frame that differs from the model in chosen ways.

All contexts may differ from row to row, two of which are stiffnesses. The frame is solved once,
and what a row changes in it, bearings and worn members, is condensed onto their deformations.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from rga_bench.synthetic.bridges.case_study import HEIGHT, PATCH, SIDES, SPAN, WIDTH, low
from rga_bench.synthetic.bridges.full_case_study import PANELS, WEAKENED, full_case_study
from rga_bench.synthetic.bridges.model_draft import ModelDict
from rga_bench.synthetic.noise import autoregressive, stream
from rga_bench.synthetic.physics.frame import (
    Array,
    Frame,
    FrameSpring,
    Stiffness,
    deformation_stiffness,
)
from rga_bench.synthetic.physics.world import World

#: in what the physical twin differs from the model
GAPS = (
    "noise only",
    "joint rigidity",
    "flexible bearings",
    "torsional stiffness",
    "sunlit side",
    "all",
)
_STRIPES = 97  # of the patch under the crowd
_BEARING = 1e7  # [N/m] of the bearings in the frame that is condensed
_MM = 1e3


class TwinDifference(NamedTuple):
    """How the physical twin differs from the model.

    ``joint`` [N m/rad] of all truss members, 0 where they are pinned; ``bearing`` [N/m] upright,
    under the four corners, inf where they are rigid; ``torsion`` [-] on GJ; ``sunlit`` [-]: how
    much warmer the southern truss is than the northern, per kelvin of the gradient where the sun
    shines; ``deck`` [-]: what the deck adds to EA of the bottom chord; ``scatter`` [m] on EA, EI
    and GJ of each member; ``gain`` [c] of each sensor; ``settlement`` [m] of the south-western
    corner.
    """

    joint: float
    bearing: Array
    torsion: float
    sunlit: float
    deck: float
    scatter: Array
    gain: Array
    settlement: float


class _Condensed(NamedTuple):
    """The frame as the readings need it, ``p`` load patterns, ``w`` deformations that vary.

    ``reading`` [p, c] and ``strain`` [p, w] are what a unit of each pattern makes sensors read
    and varied parts deform, ``free`` [p, w] deforms these without force, ``pushed`` [w, c] and
    ``flexible`` [w, w] answer to a unit force in them.
    """

    reading: Array
    strain: Array
    free: Array
    pushed: Array
    flexible: Array


@dataclass(frozen=True)
class PhysicalTwin:
    """A bridge as it really is; its contexts are those of the model, in its order and units.

    ``sd`` [c] and ``phi`` [c] are standard deviation [mm] and memory of the noise.
    """

    model: ModelDict
    difference: TwinDifference
    sd: Array
    phi: Array
    _frame: _Condensed
    _worn: tuple[World, NDArray[np.int64]]

    @classmethod
    def draw(cls, seed: int, gap: str) -> PhysicalTwin:
        """The physical twin of a seed; with another gap it keeps what both have in common.

        Raises:
            ValueError: no such gap.
        """
        if gap not in GAPS:
            raise ValueError(f"no gap {gap!r}; there are {', '.join(GAPS)}")
        model = full_case_study()
        sensors, members = len(model["sensors"]), len(model["members"])
        rng = stream(seed, "physical twin")
        joint, torsion = 10.0 ** (rng.uniform([6.5, 0.5], [8.0, 1.0]) * [1, rng.choice([-1, 1])])
        bearing = 10.0 ** rng.uniform(7.5, 8.3, 4)
        sunlit, deck = rng.uniform([0.3, 0.05], [0.7, 0.2])
        scatter, gain = rng.uniform([0.02, 0.005], [0.04, 0.015])
        every = gap == "all"
        difference = TwinDifference(
            joint=joint if every or gap == "joint rigidity" else 0.0,
            bearing=bearing if every or gap == "flexible bearings" else np.full(4, np.inf),
            torsion=torsion if every or gap == "torsional stiffness" else 1.0,
            sunlit=sunlit if every or gap == "sunlit side" else 0.0,
            deck=deck if every else 0.0,
            scatter=np.exp(every * scatter * rng.standard_normal(members)),
            gain=1.0 + every * gain * rng.standard_normal(sensors),
            settlement=0.0,
        )
        stated = np.array([one["noise"] for one in model["sensors"].values()])
        sd = stated * np.exp(0.1 * rng.standard_normal(sensors))
        return _twin(model, difference, sd, rng.uniform(0.2, 0.6, sensors))

    def damaged(self, seed: int) -> PhysicalTwin:
        """The same bridge with a corner that has settled and two diagonals that have cracked."""
        rng = stream(seed, "damage")
        names = list(self.model["members"])
        diagonals = [i for i, n in enumerate(names) if "diagonals" in _groups(self.model, n)]
        scatter = self.difference.scatter.copy()
        scatter[rng.choice(diagonals, 2, replace=False)] *= rng.uniform(0.4, 0.6, 2)
        settlement = -float(rng.uniform(0.004, 0.008))
        changed = self.difference._replace(scatter=scatter, settlement=settlement)
        return _twin(self.model, changed, self.sd, self.phi)

    def read(self, contexts: Array) -> Array:
        """What the sensors read without noise [mm], shape [n, c], at ``contexts`` [n, 8]."""
        temperature, gradient, crowd, position, eccentricity, bearing, loss, wind = contexts.T
        share = _crowd(crowd, position, eccentricity)
        lateral = -self.difference.sunlit * np.maximum(gradient, 0.0)
        fields = np.column_stack([temperature, gradient, lateral, wind, np.ones(len(contexts))])
        coefficients = np.hstack([share, fields])
        with threadpool_limits(1):  # BLAS sums in another order where it has more threads
            frame = self._frame
            deformed = coefficients @ (frame.strain - frame.free)
            change = self._change(bearing, loss)
            one = np.eye(len(frame.flexible))
            push = -np.einsum("nij,nj->ni", change, deformed)[:, :, None]
            force = np.linalg.solve(one + change @ frame.flexible, push)[:, :, 0]
            moved = coefficients @ frame.reading + force @ frame.pushed
        return np.asarray(_MM * self.difference.gain * moved)

    def noise(self, rng: np.random.Generator, rows: int) -> Array:
        """Noise of the sensors [mm] in consecutive rows, shape [rows, c]."""
        return autoregressive(rng, rows, self.sd, self.phi)

    def _change(self, bearing: Array, loss: Array) -> Array:
        """Stiffness that rows have beyond the condensed frame, shape [n, w, w]."""
        world, worn = self._worn
        rows, many = len(loss), 6 * len(worn)
        out = np.zeros((rows, many + 2, many + 2))
        section, length = world.section, world.geometry.length[worn]
        whole = deformation_stiffness(length, _of(section, worn))
        many_times = np.tile(length, rows)
        thinned = _of(section, np.tile(worn, rows))
        left = np.repeat(1.0 - loss, len(worn))
        thinned = thinned._replace(
            ea=left * thinned.ea,
            ei_y=left * thinned.ei_y,
            ei_z=left * thinned.ei_z,
            gj=left * thinned.gj,
        )
        thinner = deformation_stiffness(many_times, thinned)
        less = thinner.reshape(rows, len(worn), 6, 6) - whole
        for number in range(len(worn)):
            own = slice(6 * number, 6 * number + 6)
            out[:, own, own] = less[:, number]
        for last in (many, many + 1):
            out[:, last, last] = 10.0 ** (bearing + 3.0) - _BEARING
        return out


def _twin(model: ModelDict, difference: TwinDifference, sd: Array, phi: Array) -> PhysicalTwin:
    world = World.of(model)
    if difference.joint:
        pinned = ["bottom chord", "top chord", "end posts", "diagonals"]
        world.join(pinned, difference.joint)
    world.scale_stiffness(difference.scatter)
    section = world.section
    chord = np.where(world.members_of(group="bottom chord"), 1.0 + difference.deck, 1.0)
    world.section = section._replace(ea=section.ea * chord, gj=section.gj * difference.torsion)
    corners = [f"{end} {side}" for end in ("west", "east") for side in SIDES]
    for corner, stiffness in zip(corners, difference.bearing, strict=True):
        if np.isfinite(stiffness):
            dof = world.support_dof(corner, "uz")
            world.held.discard(dof)
            world.springs.append(FrameSpring(dof, None, stiffness))
    worn = np.flatnonzero(world.members_of(group=WEAKENED))
    with threadpool_limits(1):
        frame = _condense(world, worn, difference.settlement)
    return PhysicalTwin(model, difference, sd, phi, frame, (world, worn))


def _condense(world: World, worn: NDArray[np.int64], settlement: float) -> _Condensed:
    sliding = [world.support_dof(f"east {side}", "ux") for side in SIDES]
    springs = [*world.springs, *(FrameSpring(dof, None, _BEARING) for dof in sliding)]
    frame = Frame.build(world.geometry, world.section, world.held, springs)
    geometry, many = world.geometry, 6 * len(worn)
    varied = np.zeros((world.size, many + 2))
    for number, member in enumerate(worn):
        dofs = geometry.dofs[member]
        varied[dofs, 6 * number : 6 * number + 6] += geometry.modes[member].T
    varied[sliding, [many, many + 1]] = 1.0

    decked = [world.dof(low(side, i), "uz") for side in SIDES for i in range(PANELS + 1)]
    down = np.zeros((world.size, len(decked)))
    down[decked, np.arange(len(decked))] = -1.0
    blown = np.zeros((world.size, 1))
    for node, push in world.model["effects"]["wind"]["forces"].items():
        blown[world.dof(node, "uy")] = push[1]
    middle = geometry.xyz[geometry.ends].mean(axis=1)
    warm = np.column_stack(
        [
            np.ones(len(middle)),
            (middle[:, 2] - HEIGHT / 2) / HEIGHT,
            (middle[:, 1] - WIDTH / 2) / WIDTH,
        ]
    )
    patterns = len(decked) + 5
    force = np.zeros((world.size, patterns + many + 2))
    force[:, : len(decked)] = down
    force[:, patterns - 2 : patterns - 1] = blown
    force[:, patterns:] = varied
    thermal = np.zeros((len(middle), force.shape[1]))
    thermal[:, len(decked) : len(decked) + 3] = world.alpha[:, None] * warm
    settled = np.zeros_like(force)
    corner = world.support_dof("west south", "uz")
    if corner in world.held:
        settled[corner, patterns - 1] = settlement
    else:
        stiffness = next(s.stiffness for s in world.springs if s.a == corner)
        force[corner, patterns - 1] = stiffness * settlement
    u = frame.solve(force, thermal, settled).u

    readings = np.zeros((len(world.model["sensors"]), world.size))
    for row, sensor in enumerate(world.model["sensors"].values()):
        first = world.dof(sensor["node"], "ux")
        readings[row, first : first + 3] = sensor["direction"]
    free = np.zeros((patterns, many + 2))
    free[:, 0:many:6] = (geometry.length[worn, None] * thermal[worn, :patterns]).T
    answers = (readings @ u).T
    strains = u.T @ varied
    return _Condensed(
        answers[:patterns], strains[:patterns], free, answers[patterns:], strains[patterns:]
    )


def _crowd(crowd: Array, position: Array, eccentricity: Array) -> Array:
    """Load [N] on each node of the deck, side after side, shape [n, 2 (PANELS + 1)].

    The patch is cut into stripes, each shared by the nodes beside it.
    """
    panel = SPAN / PANELS
    stripe = PATCH * ((np.arange(_STRIPES) + 0.5) / _STRIPES - 0.5)
    place = np.clip(position[:, None] + stripe, 0.0, SPAN)
    node = np.minimum((place / panel).astype(np.int64), PANELS - 1)
    right = place / panel - node
    each = 1e3 * crowd[:, None] * PATCH * WIDTH / 2.0 / _STRIPES
    shared = np.zeros((len(crowd), PANELS + 1))
    row = np.arange(len(crowd))[:, None]
    np.add.at(shared, (row, node), each * (1.0 - right))
    np.add.at(shared, (row, node + 1), each * right)
    sides = [1.0 + np.sign(y - WIDTH / 2) * 2.0 * eccentricity for y in SIDES.values()]
    return np.hstack([side[:, None] * shared for side in sides])


def _of(section: Stiffness, chosen: NDArray[np.int64]) -> Stiffness:
    return Stiffness(*(part[chosen] for part in section))


def _groups(model: ModelDict, member: str) -> list[str]:
    groups: list[str] = model["members"][member]["groups"]
    return groups
