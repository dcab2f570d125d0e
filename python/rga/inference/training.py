"""Training of the data-driven model: domain-adversarial, guided by physics."""

from collections.abc import Callable

import numpy as np
import torch
from torch import Tensor, nn

from rga.errors import InputError
from rga.inference.beginning import begin
from rga.inference.corruption import Corruption
from rga.inference.determinism import one_thread
from rga.inference.losses import REACH, context_loss, excess, physics_loss
from rga.inference.network import ContextNetwork
from rga.inference.networks import DomainDiscriminator, Mixture, initialise
from rga.inference.reduced import pretrain
from rga.inference.reversal import reverse_gradient
from rga.inference.samples import Samples
from rga.inference.schedule import falling, reversal_strength
from rga.inference.settings import TrainingSettings
from rga.inference.variables import Variables
from rga.model.parameter import FloatArray

#: contexts in physical units, float[n, contexts] in the order of the model -> readings,
#: float[n, sensors], or float[ways, n, sensors] where the structure may answer in several ways
Physics = Callable[[Tensor], Tensor]
#: share of a first training that sees the source alone: real rows say little to a network that
#: does not yet know what readings mean
LEAD = 0.4
#: the target is looked at every so many steps, with that much more weight: it costs most
EVERY = 2
#: steps after which source rows are matched with target rows anew
MATCHING = 100


def train(
    source: Samples,
    target: Samples,
    settings: TrainingSettings,
    *,
    variables: Variables,
    noise: FloatArray,
    seed: int,
    physics: Physics | None = None,
    start: ContextNetwork | None = None,
    progress: Callable[[float], None] | None = None,
) -> ContextNetwork:
    """Train encoder and context predictor on simulated and real rows.

    L = alpha L_domain + beta L_context + gamma L_physics. L_context is the likelihood of the
    source's contexts under the candidates predicted, in units of the ranges; L_physics the robust
    mismatch of the simulation at the contexts inferred from the target and the target's readings.
    L_domain is the cross-entropy of a discriminator behind gradient reversal.

    Args:
        source: simulated rows without noise, contexts known.
        target: real rows; their latent contexts are never looked at.
        settings: weights, sizes and steps.
        variables: sensors and contexts.
        noise: standard deviation of every sensor, then of every measured context, in their units,
            float[sensors + measured].
        seed: of weights, batches and noise.
        physics: what the physics loss compares with; left out, it is pre-trained on the source
            where the settings say "reduced".
        start: an earlier network to fine-tune; its input scaling is kept.
        progress: told the share that is done.

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
    kind = settings.physics if start is None else settings.fine_physics
    if kind == "exact" and physics is None:
        raise InputError("the exact physics are missing", "training", "give Simulator.as_torch()")
    if start is not None and start.variables != variables:
        remedy = "train a network from the beginning"
        raise InputError("the earlier network is of other variables", "training", remedy)
    gamma = settings.gamma if start is None else settings.fine_gamma
    guided = kind is not None and gamma > 0 and len(target) > 0
    if guided and physics is None:
        physics = pretrain(source, variables, settings, seed=seed)
    with one_thread():
        return _Training(
            source, latent, target, settings, variables, noise, seed, start
        ).run(physics if guided else None, progress)  # fmt: skip


class _Training:
    def __init__(
        self,
        source: Samples,
        latent: FloatArray,
        target: Samples,
        settings: TrainingSettings,
        variables: Variables,
        noise: FloatArray,
        seed: int,
        start: ContextNetwork | None,
    ) -> None:
        self.settings = settings
        self.generator = torch.Generator().manual_seed(seed)
        self.source, self.target = (
            torch.from_numpy(rows.channels).float() for rows in (source, target)
        )
        self.order = torch.from_numpy(
            np.argsort([*variables.measured_columns, *variables.latent_columns])
        )
        self.sensors = len(variables.sensors)
        self.middle = torch.from_numpy(variables.middle[variables.measured_columns]).float()
        sigma = torch.from_numpy(np.asarray(noise)).float()
        spread, centre = torch.std_mean(self.source, dim=0)
        self.corrupt = Corruption(
            sigma, centre, spread, torch.arange(len(sigma)) < self.sensors, settings, self.generator
        )
        self.scale = torch.hypot(sigma, settings.gain * spread)[: self.sensors].clamp(min=1e-12)
        self.backwards = torch.zeros(len(source), dtype=torch.int64)
        if source.reversed is not None:
            self.backwards = torch.from_numpy(source.reversed).long()
        if start is None:
            self.network = begin(
                source, latent, variables, settings, sigma, self.corrupt, self.generator
            )
        else:
            self.network = ContextNetwork.from_bytes(start.to_bytes())
            self.network.thaw()
        self.wanted = self.network.standard(torch.from_numpy(latent))
        self.fresh = start is None
        self.gamma = settings.gamma if self.fresh else settings.fine_gamma
        self.discriminator = DomainDiscriminator(self.network.features, settings.width // 2)
        initialise(self.discriminator, self.generator)

    def run(
        self, physics: Physics | None, progress: Callable[[float], None] | None
    ) -> ContextNetwork:
        settings = self.settings
        steps = settings.steps if self.fresh else settings.fine_steps
        rate = settings.learning_rate if self.fresh else settings.fine_learning_rate
        modules = nn.ModuleList([self.network.encoder, self.network.predictor, self.discriminator])
        modules.train()
        optimiser = torch.optim.Adam(modules.parameters(), lr=rate, fused=True)
        for step in range(steps):
            for group in optimiser.param_groups:
                group["lr"] = rate * falling(step / steps)
            if step % MATCHING == 0:
                self._match()
            optimiser.zero_grad()
            torch.autograd.backward(self._loss(step, steps, physics))
            nn.utils.clip_grad_norm_(modules.parameters(), 1.0)
            optimiser.step()
            if progress is not None:
                progress((step + 1) / steps)
        if not all(torch.isfinite(weight).all() for weight in modules.parameters()):
            raise InputError(
                "the training of the networks diverged",
                "settings of the training",
                "take smaller weights or learning rates",
            )
        self.network.freeze()
        return self.network

    def _match(self) -> None:
        """Find a source row in a like context for each target row, as far as it is inferred now.

        Contexts over their whole ranges against those that happened to occur would be told apart
        by the contexts themselves, and the encoder would be made to forget them.
        """
        if len(self.target) == 0:
            return
        with torch.no_grad():
            mixture: Mixture = self.network.predictor(self.network.encoder(self.target))
            best = mixture.log_share.argmax(1)
            value = mixture.value[torch.arange(len(best)), best]
            self.alike = torch.cdist(value, self.wanted).argmin(1)

    def _loss(self, step: int, steps: int, physics: Physics | None) -> Tensor:
        settings, network, done = self.settings, self.network, step / steps
        rows = torch.randint(len(self.source), (settings.batch,), generator=self.generator)
        features = network.encoder(self.corrupt(self.source[rows]))
        loss = settings.beta * context_loss(
            network.predictor(features), self.wanted[rows], self.backwards[rows], network.ways
        )
        adversarial = settings.alpha > 0 and len(self.target) > 0
        lead = LEAD if self.fresh else 0.0
        if done < lead or step % EVERY or not (adversarial or physics is not None):
            return loss
        strength = reversal_strength((done - lead) / (1.0 - lead))
        size = min(settings.target_batch, len(self.target))
        chosen = torch.randperm(len(self.target), generator=self.generator)[:size]
        real = self.target[chosen]
        real_features = network.encoder(real)
        if adversarial:
            likes = network.encoder(self.corrupt(self.source[self.alike[chosen]]))
            both = reverse_gradient(torch.cat([likes, real_features]), strength)
            logits = self.discriminator(both)
            domain = torch.cat([torch.zeros(size), torch.ones(size)])
            crossed = nn.functional.binary_cross_entropy_with_logits(logits, domain)
            loss = loss + EVERY * settings.alpha * crossed
        if physics is not None:
            weight = EVERY * self.gamma * strength
            loss = loss + weight * self._physics_loss(physics, real, real_features)
        return loss

    def _physics_loss(self, physics: Physics, real: Tensor, features: Tensor) -> Tensor:
        network, sensors = self.network, self.sensors
        mixture: Mixture = network.predictor(features)
        value = mixture.value.clamp(-REACH, REACH)
        rows, modes, contexts = mixture.value.shape
        latent = network.physical(value.reshape(rows * modes, contexts))
        measured = real[:, sensors:]
        measured = torch.where(torch.isfinite(measured), measured, self.middle)
        measured = measured.repeat_interleave(modes, 0).double()
        simulated = physics(torch.cat([measured, latent], dim=1)[:, self.order])
        simulated = simulated.view(-1, rows, modes, sensors).to(real.dtype)
        # Each candidate is judged by the way that it takes the train to go.
        way = torch.arange(modes) % network.ways % len(simulated)
        simulated = simulated[way, :, torch.arange(modes)].transpose(0, 1)
        share = mixture.log_share.exp()
        fit = physics_loss(simulated, real[:, None, :sensors], self.scale)
        return (share * fit).sum(1).mean() + excess(mixture.value).square().mean()
