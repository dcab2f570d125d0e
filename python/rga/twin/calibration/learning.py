"""The ways to infer contexts, by their names in the settings. Only networks need torch."""

from rga.errors import InputError
from rga.inference import Joint
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.joint_posterior import JointEstimator, why_not
from rga.twin.calibration.lesson import Lesson
from rga.twin.settings import Inference
from rga.twin.simulation_model import SimulationModel


def learn(
    inference: Inference,
    lesson: Lesson,
    *,
    begun: Joint | None = None,
    earlier: Joint | None = None,
) -> ContextEstimator:
    """An estimator that has learned; networks where the joint posterior cannot be had.

    These learn about the structure as it was found earlier, where it was.

    Args:
        inference: the way to infer.
        lesson: what to learn from.
        begun: what the joint posterior has found of some of its rows.
        earlier: what it has found of earlier rows, maybe under another version of the model.
    """
    barred = inference == "networks" or why_not(lesson, earlier) is not None
    if barred and earlier is None:
        from rga.twin.calibration.networks import NetworkEstimator

        return NetworkEstimator.learn(lesson)
    if barred:
        assert earlier is not None
        joint = JointEstimator.carried(lesson, earlier)
    else:
        joint = JointEstimator.learn(lesson, start=begun, earlier=earlier)
        if inference == "joint":
            return joint
    from rga.twin.calibration.amortised import AmortisedEstimator

    return AmortisedEstimator.learn(lesson, joint)


def written(estimator: ContextEstimator) -> bytes:
    """An estimator as a repository keeps it."""
    return estimator.kind.encode() + b"\n" + estimator.to_bytes()


def read(content: bytes, simulation: SimulationModel) -> ContextEstimator:
    """What `written` wrote, about the same simulation.

    Raises:
        InputError: the bytes hold something else.
    """
    kind, _, state = content.partition(b"\n")
    if kind == b"joint":
        return JointEstimator.from_bytes(state, simulation)
    if kind == b"networks":
        from rga.twin.calibration.networks import NetworkEstimator

        return NetworkEstimator.from_bytes(state, simulation)
    if kind == b"amortised":
        from rga.twin.calibration.amortised import AmortisedEstimator

        return AmortisedEstimator.from_bytes(state, simulation)
    raise InputError("these bytes hold no estimator", "stored estimator", "begin a new run")
