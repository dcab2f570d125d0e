"""What a training makes small: L = alpha L_domain + beta L_context + gamma L_physics."""

import torch
from torch import Tensor, nn

from rga.arrays import FloatArray
from rga.inference.networks.augmentation import Corruption
from rga.inference.networks.context_network import ContextNetwork
from rga.inference.networks.dataset import Samples
from rga.inference.networks.domain import Adversary, Coral
from rga.inference.networks.layers import Mixture, initialise
from rga.inference.networks.losses import REACH, context_loss, excess, physics_loss
from rga.inference.networks.physics_guidance import Guide
from rga.inference.networks.schedule import reversal_strength
from rga.inference.networks.settings import TrainingSettings

#: physics and target are looked at every so many steps, with that much more weight: they cost most
EVERY = 2


class Objective:
    """The loss of a network on a batch of simulated rows and one of real rows.

    Args:
        network: that learns.
        source, target: simulated and real rows.
        latent: contexts of the simulated rows, float[n, latent].
        settings: weights of the losses and sizes of batches; `gamma` is that of this training.
        corrupt: what reality does to channels.
        scale: of a residual that physics and readings may differ by, float[sensors].
        guides: simulations of the rows of the source and of the target, None where no physics
            guides them.
        generator: what batches are drawn from.
    """

    def __init__(
        self,
        network: ContextNetwork,
        source: Samples,
        latent: FloatArray,
        target: Samples,
        settings: TrainingSettings,
        corrupt: Corruption,
        scale: Tensor,
        guides: tuple[Guide | None, Guide | None],
        generator: torch.Generator,
    ) -> None:
        self.network, self._settings, self._generator = network, settings, generator
        self._corrupt, self._scale = corrupt, scale
        self._source, self._target = (
            torch.from_numpy(rows.channels).float() for rows in (source, target)
        )
        self._backwards = torch.zeros(len(source), dtype=torch.int64)
        if source.reversed is not None:
            self._backwards = torch.from_numpy(source.reversed).long()
        self._wanted = network.standard(torch.from_numpy(latent))
        self._of_source, self._of_target = guides
        if self._of_source is not None:
            known = torch.from_numpy(latent)[:, None]
            self._of_source.look(known.expand(-1, network.predictor.modes, -1))
        adversarial = settings.domain == "adversarial"
        self.domain: Adversary | Coral = (
            Adversary(network.features, settings.width // 2) if adversarial else Coral()
        )
        initialise(self.domain, generator)
        self._adapts = settings.alpha > 0 and len(target) > 0

    @property
    def modules(self) -> nn.ModuleList:
        """All that learns."""
        return nn.ModuleList([self.network.encoder, self.network.predictor, self.domain])

    def look(self) -> None:
        """Infer the target as far as that is learned now.

        Each real row finds a simulated one in a like context: contexts over their whole ranges
        against those that happened to occur would be distinguished by the contexts themselves, and
        the encoder would be made to forget them.
        """
        if len(self._target) == 0:
            return
        with torch.no_grad():
            mixture: Mixture = self.network.predictor(self.network.encoder(self._target))
            best = mixture.log_share.argmax(1)
            value = mixture.value[torch.arange(len(best)), best]
            self._alike = torch.cdist(value, self._wanted).argmin(1)
            if self._of_target is not None:
                self._of_target.look(self.network.physical(mixture.value.clamp(-REACH, REACH)))

    def on_source(self, guided: bool) -> Tensor:
        """Loss of a batch of simulated rows, with or without what physics say of them."""
        settings, network = self._settings, self.network
        rows = torch.randint(len(self._source), (settings.batch,), generator=self._generator)
        mixture: Mixture = network.predictor(network.encoder(self._corrupt(self._source[rows])))
        loss = settings.beta * context_loss(
            mixture, self._wanted[rows], self._backwards[rows], network.ways
        )
        if guided and self._of_source is not None:
            readings = self._source[rows, : len(self._scale)]
            fit = self._physics(self._of_source, rows, mixture, readings)
            loss = loss + EVERY * settings.source_gamma * fit
        return loss

    def on_target(self, done: float) -> Tensor | None:
        """Loss of a batch of real rows, None where nothing is learned from them.

        Args:
            done: share of the training on real rows that is done.
        """
        if not self._adapts and self._of_target is None:
            return None
        network, settings, strength = self.network, self._settings, reversal_strength(done)
        size = min(settings.target_batch, len(self._target))
        rows = torch.randperm(len(self._target), generator=self._generator)[:size]
        real = self._target[rows]
        features = network.encoder(real)
        loss = torch.zeros(())
        if self._adapts:
            likes = network.encoder(self._corrupt(self._source[self._alike[rows]]))
            loss = loss + EVERY * settings.alpha * self.domain(likes, features, strength)
        if self._of_target is not None:
            readings = real[:, : len(self._scale)]
            fit = self._physics(self._of_target, rows, network.predictor(features), readings)
            loss = loss + EVERY * settings.gamma * strength * fit
        return loss

    def _physics(self, guide: Guide, rows: Tensor, mixture: Mixture, readings: Tensor) -> Tensor:
        value = self.network.physical(mixture.value.clamp(-REACH, REACH))
        fit = physics_loss(guide(rows, value), readings[:, None], self._scale)
        share = mixture.log_share.exp()
        return (share * fit).sum(1).mean() + excess(mixture.value).square().mean()
