"""A network before its first step: scaled to its inputs, and right where the world is linear."""

import torch
from torch import Tensor, nn

from rga.arrays import FloatArray
from rga.inference.networks.augmentation import Corruption
from rga.inference.networks.context_network import ContextNetwork
from rga.inference.networks.dataset import Samples
from rga.inference.networks.layers import initialise, start_from_line, telling_directions
from rga.inference.networks.settings import TrainingSettings
from rga.inference.variables import Variables

#: a channel fades out beyond this many times the largest value simulated, within these bounds
BEYOND, LIMITS = 1.5, (4.0, 40.0)
ROWS = 4096
#: how much of what is drawn at random the first outputs keep
HUSHED = 0.1


def begin(
    source: Samples,
    latent: FloatArray,
    variables: Variables,
    settings: TrainingSettings,
    noise: Tensor,
    corrupt: Corruption,
    generator: torch.Generator,
) -> ContextNetwork:
    """A new network: weights drawn, inputs scaled to the source, the linear path fitted.

    Args:
        source: simulated rows.
        latent: their contexts, float[n, latent].
        variables: sensors and contexts.
        settings: sizes.
        noise: standard deviation of every channel, float[channels].
        corrupt: what reality does to channels.
        generator: what weights are drawn from.
    """
    ways = 1 if source.reversed is None or not source.reversed.any() else 2
    network = ContextNetwork(variables, settings.width, settings.features, settings.modes, ways)
    encoder, predictor = network.encoder, network.predictor
    for part in (encoder, predictor):
        initialise(part, generator)

    channels = torch.from_numpy(source.channels).float()
    spread, centre = torch.std_mean(channels, dim=0)
    scale = torch.hypot(spread, noise)
    scale = torch.where(scale > 0, scale, 1.0)
    largest = ((channels - centre).abs() + 4 * noise).amax(0)
    encoder.centre.copy_(centre)
    encoder.scale.copy_(scale)
    encoder.limit.copy_((BEYOND * largest / scale).clamp(*LIMITS))
    allowed = torch.hypot(noise, corrupt.gain * spread) / scale
    encoder.rotation.copy_(telling_directions((channels - centre) / scale, allowed))

    # Only what is curved is left to learn when the linear map stands at the beginning.
    wanted = network.standard(torch.from_numpy(latent[:ROWS]))
    start_from_line(encoder.linear, encoder.standardise(corrupt(channels[:ROWS])), wanted)
    contexts = wanted.shape[1]
    with torch.no_grad():
        _last(encoder.curved).weight[:contexts] *= HUSHED**2
        _last(predictor.curved).weight *= HUSHED
        predictor.linear.weight.zero_()
        predictor.linear.weight[:, :contexts] = torch.eye(contexts)
        predictor.linear.bias.zero_()
    return network


def _last(layers: nn.Sequential) -> nn.Linear:
    layer = layers[-1]
    assert isinstance(layer, nn.Linear)
    return layer
