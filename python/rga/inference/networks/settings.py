"""How a network is trained."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from rga.no_booleans import NO_BOOLEAN

Weight = Annotated[float, Field(ge=0, allow_inf_nan=False), NO_BOOLEAN]
Rate = Annotated[float, Field(gt=0, lt=1), NO_BOOLEAN]
Count = Annotated[int, Field(ge=1, le=1_000_000), NO_BOOLEAN]
#: units of a layer: a network of more has more weights than a machine holds
Width = Annotated[int, Field(ge=1, le=4096), NO_BOOLEAN]
Modes = Annotated[int, Field(ge=1, le=64), NO_BOOLEAN]
Batch = Annotated[int, Field(ge=1, le=65_536), NO_BOOLEAN]
Share = Annotated[float, Field(ge=0, lt=1), NO_BOOLEAN]


class TrainingSettings(BaseModel):
    """Weights of the losses, sizes and steps.

    Attributes:
        alpha, beta, gamma: weights of the domain, context and physics losses [-].
        source_gamma: weight of the physics loss on simulated rows [-].
        domain: what the domain loss is: an adversary's, or the distance of covariances.
        fine_gamma: weight of the physics loss in a fine-tuning, which is about few rows [-].
        physics: what the physics loss compares with: the frozen network trained on the source,
            the simulator itself, or nothing.
        fine_physics: the same in a fine-tuning, whose rows may lie beyond all of the source.
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

    model_config = ConfigDict(extra="forbid", frozen=True)
    alpha: Weight = 0.02
    beta: Weight = 1.0
    gamma: Weight = 0.005
    source_gamma: Weight = 0.0
    domain: Literal["adversarial", "coral"] = "adversarial"
    fine_gamma: Weight = 0.5
    physics: Literal["reduced", "exact"] | None = "reduced"
    fine_physics: Literal["reduced", "exact"] | None = "exact"
    steps: Count = 2500
    learning_rate: Rate = 3e-3
    fine_steps: Count = 120
    fine_learning_rate: Rate = 2e-3
    reduced_steps: Count = 2000
    reduced_width: Width = 96
    batch: Batch = 128
    target_batch: Batch = 48
    width: Width = 96
    features: Width = 32
    modes: Modes = 6
    dropout: Share = 0.02
    faults: Share = 0.002
    gain: Share = 0.03

    def fine(self) -> "TrainingSettings":
        """The settings of a fine-tuning, as those of a training."""
        return self.model_copy(
            update={
                "gamma": self.fine_gamma,
                "physics": self.fine_physics,
                "steps": self.fine_steps,
                "learning_rate": self.fine_learning_rate,
            }
        )
