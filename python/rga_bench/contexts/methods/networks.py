"""The networks of the table: one way to learn, and what each row takes from it.

- `source_only` sees simulated rows alone.
- `residual_network` has the residual for its loss, of simulated and of real rows, between readings
  and what a frozen network simulates at the contexts inferred; known contexts are not looked at.
- `adversarial` and `coral` make features of simulated and real rows alike.
- `adversarial_reduced_physics` and `adversarial_exact_physics` are guided by the frozen network
  and by the simulator as well, on simulated and on real rows; `physics_only` by the simulator
  without an adversary.

All but the first stop where the gap on held-out real rows is least, as
`rga.inference.networks.selection.unlabelled_gap` measures it.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from rga.arrays import FloatArray
from rga.inference import ContextNetwork, Samples, TrainingSettings, Variables, train
from rga.inference.map.laplace import covering_factor
from rga.inference.networks.design_samples import design
from rga.inference.networks.selection import unlabelled_gap
from rga_bench.contexts.method import Estimate, LearningProblem, Method

#: simulated rows, drawn anew, on which intervals are stretched
UNSEEN = 200
#: of the real rows, one in so many decides when to stop
HELD_OUT = 5


@dataclass(frozen=True)
class LearnedNetwork:
    """A network, with what its intervals are stretched by.

    Attributes:
        problem: that it has learned from.
        settings: of its training.
        network: what infers.
        factor: on the spread of each context, float[contexts].
    """

    problem: LearningProblem
    settings: TrainingSettings
    network: ContextNetwork
    factor: FloatArray

    def infer(self, readings: FloatArray) -> Estimate:
        """The mean of the candidates, inside the ranges that are the contexts' priors."""
        value, spread = self.network.candidates(readings, np.empty((len(readings), 0))).mean()
        return Estimate(np.clip(value, *self.problem.ranges.T), spread * self.factor)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model of the problem simulates."""
        return self.problem.simulate(contexts)

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> "LearnedNetwork":
        """Fine-tuned on old and recent real rows, or on these alone, the source beside them.

        A network that learns from the source alone stays as it is.
        """
        if not _adapts(self.settings):
            return self
        rows = recent if alone else np.concatenate([self.problem.real, recent])
        problem = replace(self.problem, real=rows)
        return learn(self.settings, problem, self.network)


def learn(
    settings: TrainingSettings, problem: LearningProblem, start: ContextNetwork | None = None
) -> LearnedNetwork:
    """Train a network, or fine-tune an earlier one.

    Args:
        settings: of the training.
        problem: what to learn from; its load tests are not looked at.
        start: the earlier network.
    """
    variables = Variables.of(problem.model, tuple(problem.model.context))
    source = Samples(
        problem.source.readings, np.empty((len(problem.source.readings), 0)),
        problem.source.contexts,
    )  # fmt: skip
    real = problem.real if _adapts(settings) else problem.real[:0]
    held_out = np.arange(len(real)) % HELD_OUT == HELD_OUT - 1
    network = train(
        source,
        Samples(real[~held_out], np.empty((int(np.sum(~held_out)), 0))),
        settings,
        variables=variables,
        noise=problem.noise,
        seed=problem.seed,
        physics=problem.simulator if settings.physics == "exact" else None,
        start=start,
        held_out=partial(
            unlabelled_gap, simulator=problem.simulator, readings=real[held_out],
            noise=problem.noise,
        ) if held_out.any() else None,
    )  # fmt: skip
    learned = LearnedNetwork(problem, settings, network, np.ones(len(variables.latent)))
    return replace(learned, factor=_stretch(learned))


def _adapts(settings: TrainingSettings) -> bool:
    return settings.alpha > 0 or settings.gamma > 0


def _stretch(learned: LearnedNetwork) -> FloatArray:
    """What makes intervals cover on simulated rows that no training has seen."""
    problem = learned.problem
    # The source is drawn from the seed itself: these rows must not be its own.
    sequence, noise = np.random.SeedSequence([problem.seed, UNSEEN]).spawn(2)
    unseen = design(
        problem.model, UNSEEN, latent=tuple(problem.model.context),
        seed=int(sequence.generate_state(1)[0]),
    )  # fmt: skip
    wander = np.random.default_rng(noise).standard_normal(unseen.readings.shape)
    found = learned.infer(unseen.readings + problem.noise * wander)
    assert found.spread is not None
    return covering_factor(found.value - unseen.contexts, found.spread)


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
    "source_only": _settings(),
    "residual_network": _settings(beta=0.0, gamma=1.0, source_gamma=1.0, physics="reduced"),
    "adversarial": _settings(alpha=0.03),
    "adversarial_reduced_physics": _settings(**_BOTH, physics="reduced"),
    "adversarial_exact_physics": _settings(**_BOTH, physics="exact"),
    "physics_only": _settings(**_PHYSICS, physics="exact"),
    "coral": _settings(alpha=10.0, domain="coral"),
}

source_only: Method = partial(learn, NETWORKS["source_only"])
residual_network: Method = partial(learn, NETWORKS["residual_network"])
adversarial: Method = partial(learn, NETWORKS["adversarial"])
adversarial_reduced_physics: Method = partial(learn, NETWORKS["adversarial_reduced_physics"])
adversarial_exact_physics: Method = partial(learn, NETWORKS["adversarial_exact_physics"])
physics_only: Method = partial(learn, NETWORKS["physics_only"])
coral: Method = partial(learn, NETWORKS["coral"])
