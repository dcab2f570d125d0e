"""Which settings to train with, found without contexts of real rows.

Sensors show how well the simulation at the inferred contexts meets them, and the source shows
whether contexts are still inferred well where they are known. The first alone would choose a
network that hides what the model lacks in the contexts; the second alone one that learns nothing
from real rows.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.networks.context_network import ContextNetwork
from rga.inference.networks.dataset import Samples
from rga.inference.networks.settings import TrainingSettings
from rga.inference.networks.training import train
from rga.inference.variables import Variables
from rga.simulation import Simulator

#: one row in so many is held out, of the source and of the target
HELD_OUT = 5
#: the error on held-out source rows may be this much larger than that of the source alone
WORSE = 1.1


def unlabelled_gap(
    network: ContextNetwork,
    *,
    simulate: Callable[[FloatArray], FloatArray],
    rows: Samples,
    noise: FloatArray,
) -> float:
    """How far real rows are from the simulation at the contexts inferred for them.

    Logarithms of the squares: neither a broken channel nor a row without load rules the rest.

    Args:
        network: infers the latent contexts.
        simulate: readings, float[n, sensors], at contexts in the order of the model,
            float[n, contexts].
        rows: real ones; latent contexts in them are not looked at.
        noise: standard deviation of each sensor, float[sensors].

    Returns:
        Mean of log(1 + squared residual over the variance of the noise) [-]; infinite where
        nothing was read.
    """
    variables = network.variables
    contexts = variables.together(rows.measured, network.infer(rows.readings, rows.measured))
    contexts = np.where(np.isfinite(contexts), contexts, variables.middle)
    contexts = np.clip(contexts, *np.transpose(variables.ranges))
    off = (rows.readings - simulate(contexts)) / noise
    seen = np.isfinite(off)
    return float(np.mean(np.log1p(off[seen] ** 2))) if seen.any() else np.inf


@dataclass(frozen=True)
class SelectionTrial:
    """What became of one candidate.

    Attributes:
        settings: the candidate.
        source_error: mean squared error on held-out simulated rows; 1.0 is that of the prior's
            mean [-].
        gap: on held-out real rows, as of `unlabelled_gap` [-].
    """

    settings: TrainingSettings
    source_error: float
    gap: float


def choose(
    candidates: Sequence[TrainingSettings],
    source: Samples,
    target: Samples,
    *,
    simulator: Simulator,
    noise: FloatArray,
    seed: int,
) -> list[SelectionTrial]:
    """Train with every candidate on four fifths of the rows, and judge on the rest.

    A candidate is allowed if its error on held-out simulated rows is at most `WORSE` times that of
    a training on the source alone, which is always a candidate itself. Of those allowed, the one
    with the least gap on held-out real rows is chosen.

    Args:
        candidates: settings.
        source: simulated rows with known contexts, none of them measured.
        target: real rows; contexts in them are not looked at.
        simulator: of the model.
        noise: standard deviation of each sensor, float[sensors].
        seed: of everything random.

    Returns:
        A trial for the source alone and for each candidate: the chosen one first, then the others
        that are allowed by their gap, then those that are not.

    Raises:
        InputError: no candidate, or fewer than `HELD_OUT` rows of either kind.
    """
    if not candidates:
        raise InputError("there is nothing to choose from", "choice of settings", "give some")
    if min(len(source), len(target)) < HELD_OUT:
        remedy = f"give {HELD_OUT} rows of the source and of the target, or more"
        raise InputError("there are too few rows to hold some out", "choice of settings", remedy)
    variables = Variables.of(simulator.model, tuple(simulator.model.context))
    (source, unseen), (target, held_out) = _apart(source), _apart(target)
    known = unseen.known(variables, "source")
    wander = np.random.default_rng(seed).standard_normal(unseen.readings.shape)
    noisy = unseen.readings + noise * wander

    def simulate(contexts: FloatArray) -> FloatArray:
        return simulator.predict(dict(zip(variables.contexts, contexts.T, strict=True)))

    judge = partial(unlabelled_gap, simulate=simulate, rows=held_out, noise=noise)

    def attempt(settings: TrainingSettings) -> SelectionTrial:
        network = train(
            source, target, settings, variables=variables, noise=noise, seed=seed,
            physics=simulator if settings.physics == "exact" else None, held_out=judge,
        )  # fmt: skip
        found, _ = network.candidates(noisy, unseen.measured).mean()
        error = float(np.mean(12.0 * ((found - known) / variables.width) ** 2))
        return SelectionTrial(settings, error, judge(network))

    alone = attempt(
        candidates[0].model_copy(update={"alpha": 0.0, "gamma": 0.0, "source_gamma": 0.0})
    )
    trials = [alone, *(attempt(settings) for settings in candidates)]
    return sorted(
        trials, key=lambda trial: (trial.source_error > WORSE * alone.source_error, trial.gap)
    )


def _apart(rows: Samples) -> tuple[Samples, Samples]:
    """What is learned from, and what is held out."""
    held_out = np.arange(len(rows)) % HELD_OUT == HELD_OUT - 1
    return rows.rows(~held_out), rows.rows(held_out)
