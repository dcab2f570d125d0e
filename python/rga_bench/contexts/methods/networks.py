"""The networks of the table: the product's, each row with settings of its own.

- `source only` sees simulated rows alone.
- `residual network` has the residual for its loss, of simulated and of real rows, between readings
  and what a frozen network simulates at the contexts inferred; known contexts are not looked at.
- `DANN` and `CORAL` make features of simulated and real rows alike.
- `DANN + physics` are guided by the frozen network or by the simulator as well, on simulated and
  on real rows; `physics only` by the simulator without an adversary.
"""

from dataclasses import replace
from typing import Self

from rga.inference import TrainingSettings
from rga.twin.calibration.estimator import Learn
from rga.twin.calibration.lesson import Lesson
from rga.twin.calibration.networks import NetworkEstimator

_BASE = TrainingSettings(
    alpha=0.0, gamma=0.0, fine_gamma=0.0, physics=None, fine_physics=None,
    steps=1200, learning_rate=6e-3, fine_steps=400, modes=1,
)  # fmt: skip


def _settings(**changes: object) -> TrainingSettings:
    """Settings of a row; a fine-tuning follows its training."""
    changed = _BASE.model_copy(update=changes)
    return changed.model_copy(update={"fine_gamma": changed.gamma, "fine_physics": changed.physics})


# Weights of the physics, of the adversary beside them and of coral: what `selection.choose` takes
# on physical twins with all gaps, seeds 1 and 2. Before the adversary alone it takes the source
# alone, and next to that the weight that stands here.
_PHYSICS = {"gamma": 0.05, "source_gamma": 0.05}
_BOTH = {**_PHYSICS, "alpha": 0.1}

#: settings of each row, by its name
NETWORKS = {
    "source only": _settings(),
    "residual network": _settings(beta=0.0, gamma=1.0, source_gamma=1.0, physics="reduced"),
    "CORAL": _settings(alpha=10.0, domain="coral"),
    "DANN": _settings(alpha=0.03),
    "DANN + physics, frozen network": _settings(**_BOTH, physics="reduced"),
    "DANN + physics, exact simulator": _settings(**_BOTH, physics="exact"),
    "physics only": _settings(**_PHYSICS, physics="exact"),
}


def trained(settings: TrainingSettings) -> Learn:
    """Learns networks with these settings, when they are refined as well.

    Where neither domain nor physics have a weight they learn from simulated rows alone, and stay
    as they are when refined.
    """
    adapts = settings.alpha > 0 or settings.gamma > 0

    class Trained(NetworkEstimator):
        @classmethod
        def learn(cls, lesson: Lesson, start: Self | None = None) -> Self:
            lesson = replace(lesson, training=settings)
            return super().learn(lesson if adapts else lesson.rows(slice(0, 0)), start)

        def refined(self, lesson: Lesson) -> Self:
            return super().refined(lesson) if adapts else self

    return Trained.learn
