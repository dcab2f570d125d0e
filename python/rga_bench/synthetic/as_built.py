"""How reality differs from every model of it: scatter in members and gains, noise with memory."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rga_bench.synthetic.bridges.model_draft import ModelDict
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.world import World


class AsBuilt(NamedTuple):
    """A bridge as it was built, its truss members still pinned.

    ``scatter`` and ``gain`` are the standard deviations of the stiffness of the members and of
    the gains of the channels [-], ``joint`` is the stiffness that its joints have in a frame
    reality [N m/rad], ``sd`` [c] and ``phi`` [c] are those of the noise.
    """

    world: World
    scatter: float
    gain: float
    joint: float
    sd: Array
    phi: Array

    @property
    def facts(self) -> dict[str, Any]:
        """What a truth file says of it."""
        return {
            "scatter": {"EA": self.scatter, "gain": self.gain},
            "noise_memory": [float(p) for p in self.phi],
        }


def build(
    model: ModelDict,
    rng: np.random.Generator,
    joints: tuple[float, float] = (6.0, 9.0),
    given: float | None = None,
) -> AsBuilt:
    """Draw a reality of ``model``.

    ``joints`` bounds log10 of the joints' stiffness; ``given`` is the scatter of the members,
    half of it that of the gains, where it is not drawn.
    """
    sensors = model["sensors"]
    count = len(sensors)
    scatter, gain = float(rng.uniform(0.01, 0.04)), float(rng.uniform(0.005, 0.02))
    if given is not None:
        scatter, gain = given, given / 2.0
    world = World.of(model)
    world.scale_stiffness(np.exp(scatter * rng.standard_normal(len(world.alpha))))
    world.sensor_ops.append(("gains", 1.0 + gain * rng.standard_normal(count)))
    joint = float(f"{10.0 ** rng.uniform(*joints):.4g}")
    sd = np.array([s["noise"] for s in sensors.values()])
    sd = sd * np.exp(0.1 * rng.standard_normal(count))
    return AsBuilt(world, scatter, gain, joint, sd, rng.uniform(0.2, 0.7, count))
