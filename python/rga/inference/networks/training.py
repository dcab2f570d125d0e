"""Training of the data-driven model: domain-adversarial, guided by physics."""

from collections.abc import Callable

import numpy as np
import torch
from torch import nn

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.networks.augmentation import Corruption
from rga.inference.networks.context_network import ContextNetwork
from rga.inference.networks.dataset import Samples
from rga.inference.networks.determinism import one_thread
from rga.inference.networks.network_init import begin
from rga.inference.networks.objective import EVERY, Objective
from rga.inference.networks.physics_guidance import Guide, Physics
from rga.inference.networks.schedule import falling
from rga.inference.networks.settings import TrainingSettings
from rga.inference.networks.stopping import Stopping
from rga.inference.networks.surrogate import pretrain
from rga.inference.variables import Variables
from rga.simulation import Simulator

#: share of a first training that sees the source alone: real rows say little to a network that
#: does not yet know what readings mean
LEAD = 0.4
#: steps after which source rows are matched with target rows, and tangents taken, anew
MATCHING = 50


def train(
    source: Samples,
    target: Samples,
    settings: TrainingSettings,
    *,
    variables: Variables,
    noise: FloatArray,
    seed: int,
    physics: Physics | Simulator | TwinOnArrays | None = None,
    start: ContextNetwork | None = None,
    held_out: Callable[[ContextNetwork], float] | None = None,
    progress: Callable[[float], None] | None = None,
) -> ContextNetwork:
    """Train encoder and context predictor on simulated and real rows.

    L = alpha L_domain + beta L_context + gamma L_physics. L_context is the likelihood of the
    source's contexts under the candidates predicted, in units of the ranges; L_physics the robust
    mismatch of the simulation at the contexts inferred from the target and the target's readings.
    L_domain is the cross-entropy of a discriminator behind gradient reversal, or the distance of
    covariances.

    Args:
        source: simulated rows without noise, contexts known.
        target: real rows; their latent contexts are never looked at.
        settings: weights, sizes and steps.
        variables: sensors and contexts.
        noise: standard deviation of every sensor, then of every measured context, in their units,
            float[sensors + measured].
        seed: of weights, batches and noise.
        physics: what the physics loss compares with: a differentiable simulation, or a simulator
            of rows that stand alone, which is followed along its tangents; left out, it is
            pre-trained on the source where the settings say "reduced".
        start: an earlier network to fine-tune; its input scaling is kept.
        held_out: measures how wrong a network is, on rows that it does not learn from. The
            network where that was least is kept, and the training ends once it no longer falls.
        progress: called with the share that is done.

    Raises:
        InputError: samples or a network to start from that do not fit the variables, or "exact"
            physics without a simulator.
    """
    latent = source.known(variables, "source")
    target.check(variables, "target")
    if len(noise) != len(variables.sensors) + len(variables.measured):
        raise InputError(
            f"there are {len(noise)} noise levels", "training", "give one a sensor and context"
        )
    if start is not None:
        if start.variables != variables:
            remedy = "train a network from the beginning"
            raise InputError("the earlier network is of other variables", "training", remedy)
        settings = settings.fine()
    if settings.physics == "exact" and physics is None:
        raise InputError(
            "the exact physics are missing",
            "training",
            "give Simulator.as_torch(), or the simulator",
        )
    sides = (settings.source_gamma > 0, settings.gamma > 0 and len(target) > 0)
    guided = [settings.physics is not None and side for side in sides]
    if any(guided) and physics is None:
        physics = pretrain(source, variables, settings, seed=seed)
    if isinstance(physics, Simulator):
        physics = TwinOnArrays(physics)
    with one_thread():
        generator = torch.Generator().manual_seed(seed)
        sigma = torch.from_numpy(np.asarray(noise)).float()
        spread, centre = torch.std_mean(torch.from_numpy(source.channels).float(), dim=0)
        sensors = torch.arange(len(sigma)) < len(variables.sensors)
        corrupt = Corruption(sigma, centre, spread, sensors, settings, generator)
        scale = torch.hypot(sigma, settings.gain * spread)[sensors].clamp(min=1e-12)
        if start is None:
            network = begin(source, latent, variables, settings, sigma, corrupt, generator)
        else:
            network = ContextNetwork.from_bytes(start.to_bytes())
            network.thaw()
        of_source, of_target = (
            Guide(physics, rows.measured, variables, network.ways) if wanted and physics else None
            for wanted, rows in zip(guided, (source, target), strict=True)
        )
        objective = Objective(
            network, source, latent, target, settings, corrupt, scale, (of_source, of_target),
            generator,
        )  # fmt: skip
        lead = LEAD if start is None else 0.0
        return _run(objective, settings, lead, held_out, progress)


def _run(
    objective: Objective,
    settings: TrainingSettings,
    lead: float,
    held_out: Callable[[ContextNetwork], float] | None,
    progress: Callable[[float], None] | None,
) -> ContextNetwork:
    steps, rate = settings.steps, settings.learning_rate
    first = round(lead * steps)
    weights = list(objective.modules.train().parameters())
    optimiser = torch.optim.Adam(weights, lr=rate, fused=True)
    stopping = None if held_out is None else Stopping(held_out)
    for step in range(steps):
        done = step / steps
        for group in optimiser.param_groups:
            group["lr"] = rate * falling(done)
        if step >= first and (step - first) % MATCHING == 0:
            objective.look()
            if stopping is not None and stopping.enough(objective.network):
                break
        optimiser.zero_grad()
        whole = step % EVERY == 0
        loss = objective.on_source(guided=whole)
        if whole and step >= first:
            real = objective.on_target((step - first) / (steps - first))
            loss = loss if real is None else loss + real
        torch.autograd.backward(loss)
        nn.utils.clip_grad_norm_(weights, 1.0)
        optimiser.step()
        if progress is not None:
            progress((step + 1) / steps)
    if not all(torch.isfinite(weight).all() for weight in weights):
        raise InputError(
            "the training of the networks diverged",
            "settings of the training",
            "take smaller weights or learning rates",
        )
    objective.network.freeze()
    if stopping is not None:
        return stopping.best(objective.network)
    return objective.network
