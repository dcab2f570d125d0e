"""Networks on the corrected twin: they answer a row at once, and less well than the posterior."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Self

import numpy as np

from rga.arrays import FloatArray
from rga.inference import Joint, TrainingSettings
from rga.model import ContextVariable
from rga.twin.calibration.correction import Correction
from rga.twin.calibration.joint_posterior import JointEstimator, why_not
from rga.twin.calibration.lesson import Lesson
from rga.twin.calibration.networks import NetworkEstimator
from rga.twin.simulation_model import SimulationModel

#: size and steps of the networks, over what settings say: what is left to learn is finer
FINER = 2


class AmortisedEstimator:
    """A joint posterior that corrects the twin, and networks that have learned from that.

    Args:
        joint: what corrects.
        networks: what infers.
    """

    kind = "amortised"
    remembers = False

    def __init__(self, joint: JointEstimator, networks: NetworkEstimator) -> None:
        self.joint, self.networks = joint, networks

    @classmethod
    def learn(
        cls, lesson: Lesson, joint: JointEstimator, start: NetworkEstimator | None = None
    ) -> Self:
        """Networks that learn from simulations of the twin as a joint posterior corrects it.

        Args:
            lesson: what the joint posterior has learned from.
            joint: it.
            start: networks to refine; None: new ones.
        """
        noise = np.full(len(lesson.noise), np.nan)
        noise[joint.watched] = np.sqrt(np.diagonal(joint.found.covariance))
        corrected = lesson.corrected(joint.correction, noise)
        return cls(
            joint, NetworkEstimator.learn(replace(corrected, training=_finer(lesson)), start)
        )

    def refined(self, lesson: Lesson) -> Self:
        """What both become by the new rows of a lesson."""
        fixed = why_not(lesson, self.joint.found) is not None
        joint = self.joint if fixed else self.joint.refined(lesson)
        return self.learn(lesson, joint, self.networks)

    @property
    def found(self) -> Joint:
        """The joint posterior."""
        return self.joint.found

    @property
    def correction(self) -> Correction:
        """What the joint posterior has found of structure and sensors."""
        return self.joint.correction

    def infer(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        laws: Sequence[ContextVariable],
    ) -> tuple[FloatArray, FloatArray]:
        """Latent contexts from a row on, and their standard deviations (`ContextEstimator`)."""
        return self.networks.infer(first, readings, contexts, time, laws)

    def to_bytes(self) -> bytes:
        """Everything but the simulation."""
        joint = self.joint.to_bytes()
        return json.dumps({"joint": len(joint)}).encode() + b"\n" + joint + self.networks.to_bytes()

    @classmethod
    def from_bytes(cls, content: bytes, simulation: SimulationModel) -> Self:
        """What `to_bytes` wrote, about the same simulation, corrected as it was."""
        head, _, both = content.partition(b"\n")
        end = json.loads(head)["joint"]
        joint = JointEstimator.from_bytes(both[:end], simulation)
        corrected = SimulationModel(simulation.model, simulation.station, joint.correction)
        return cls(joint, NetworkEstimator.from_bytes(both[end:], corrected))


def _finer(lesson: Lesson) -> TrainingSettings:
    """How networks are trained on a corrected twin.

    Gains are found already, and readings fit several contexts only where a load moves.
    """
    given, laws = lesson.training, lesson.simulation.model.context
    alone = all(laws[name].law == "independent" for name in lesson.latent)
    return given.model_copy(
        update={
            "gain": 0.0,
            "steps": FINER * given.steps,
            "width": FINER * given.width,
            "modes": 1 if alone else given.modes,
        }
    )
