"""How a network is trained."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class TrainingSettings:
    """Weights of the losses, sizes and steps.

    Attributes:
        alpha, beta, gamma: weights of the domain, context and physics losses [-].
        fine_gamma: weight of the physics loss in a fine-tuning, which is about few rows [-].
        physics: what the physics loss compares with: the frozen network trained on the source,
            the simulator itself, or nothing.
        steps, learning_rate: of a first training.
        fine_steps, fine_learning_rate: of a fine-tuning.
        reduced_steps, reduced_width: of the reduced-order simulator.
        batch, target_batch: rows of the source and of the target in a step.
        width, features: of the hidden layers, and of what the encoder hands on.
        modes: candidates a row, where readings fit several contexts.
        dropout: share of the source's channels that are taken as missing [-].
        faults: share of the source's channels that show something arbitrary [-].
        gain: standard deviation of a random gain on every channel of the source, and model error
            that the physics loss allows for, as a share of a sensor's spread [-].
    """

    alpha: float = 0.02
    beta: float = 1.0
    gamma: float = 0.005
    fine_gamma: float = 0.5
    physics: Literal["reduced", "exact"] | None = "reduced"
    steps: int = 2500
    learning_rate: float = 3e-3
    fine_steps: int = 500
    fine_learning_rate: float = 1e-3
    reduced_steps: int = 2000
    reduced_width: int = 96
    batch: int = 128
    target_batch: int = 48
    width: int = 96
    features: int = 32
    modes: int = 6
    dropout: float = 0.02
    faults: float = 0.002
    gain: float = 0.03
