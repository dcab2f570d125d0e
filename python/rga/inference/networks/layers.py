"""The four networks of the data-driven model: encoder, predictor, discriminator, simulator."""

import math
from typing import NamedTuple

import torch
from torch import Tensor, nn


def perceptron(inputs: int, width: int, outputs: int) -> nn.Sequential:
    """Two hidden layers with smooth activations."""
    return nn.Sequential(
        nn.Linear(inputs, width), nn.SiLU(), nn.Linear(width, width), nn.SiLU(),
        nn.Linear(width, outputs),
    )  # fmt: skip


class Encoder(nn.Module):
    """theta_f: from one row of channels (sensors, then measured contexts) to features.

    Channels are standardised, and turned into directions in the order of what they show beyond
    their noise. A missing one enters as zero, and a mask says so; one far beyond
    anything simulated fades into a missing one, smoothly. Beside the perceptron a linear map
    carries what needs no curvature.

    Args:
        channels: number of sensors and measured contexts.
        width: of the hidden layers.
        features: number of features.
    """

    centre: Tensor
    scale: Tensor
    limit: Tensor
    rotation: Tensor

    def __init__(self, channels: int, width: int, features: int) -> None:
        super().__init__()
        self.register_buffer("centre", torch.zeros(channels))
        self.register_buffer("scale", torch.ones(channels))
        self.register_buffer("limit", torch.full((channels,), 10.0))
        self.register_buffer("rotation", torch.eye(channels))
        self.curved = perceptron(2 * channels, width, features)
        self.linear = nn.Linear(2 * channels, features)

    def standardise(self, channels: Tensor) -> Tensor:
        """Standardised channels and how missing each is (0..1), float[n, 2 channels]."""
        seen = torch.isfinite(channels)
        value = torch.where(seen, (channels - self.centre) / self.scale, 0.0)
        share = (value / self.limit).clamp(min=-100.0, max=100.0).square().square().square()
        weight = seen / (1.0 + share)
        return torch.cat([(value * weight) @ self.rotation, 1.0 - weight], dim=1)

    def forward(self, channels: Tensor) -> Tensor:
        """Features, float[n, features]."""
        inputs = self.standardise(channels)
        features: Tensor = self.curved(inputs) + self.linear(inputs)
        return features


class ContextPredictor(nn.Module):
    """theta_c: from features to contexts, as a mixture: readings may fit several contexts.

    Mixture density network of Bishop (NCRG/94/004, 1994). In standard units, a context spread
    evenly over its range has mean 0 and variance 1.

    Args:
        features: number of features.
        width: of the hidden layers.
        contexts: number of contexts to infer.
        modes: number of candidates a row, for each way.
        ways: 2 if a train may go backwards: every second candidate then takes it to, else 1.
    """

    def __init__(self, features: int, width: int, contexts: int, modes: int, ways: int) -> None:
        super().__init__()
        self.contexts, self.modes, self.ways = contexts, modes * ways, ways
        self.curved = perceptron(features, width, self.modes * (2 * contexts + 1))
        self.linear = nn.Linear(features, contexts)

    def forward(self, features: Tensor) -> "Mixture":
        """Candidates of every row."""
        out = self.curved(features).view(-1, self.modes, 2 * self.contexts + 1)
        correction, spread = out[..., :-1].chunk(2, dim=2)
        # A spread of the whole range says that nothing is known; more there is none to say.
        log_spread = -nn.functional.softplus(-spread).clamp(max=9.0)
        value = self.linear(features)[:, None] + correction
        return Mixture(value, log_spread, out[..., -1].log_softmax(1))


class Mixture(NamedTuple):
    """Candidates for the contexts of each row, in standard units.

    Attributes:
        value: float[n, modes, contexts].
        log_spread: logarithm of the standard deviation, float[n, modes, contexts].
        log_share: logarithm of the probability of each, float[n, modes].
    """

    value: Tensor
    log_spread: Tensor
    log_share: Tensor


class DomainDiscriminator(nn.Module):
    """theta_d: from features to the logit of the row being real."""

    def __init__(self, features: int, width: int) -> None:
        super().__init__()
        self.layers = nn.Sequential(nn.Linear(features, width), nn.SiLU(), nn.Linear(width, 1))

    def forward(self, features: Tensor) -> Tensor:
        """Logits, float[n]."""
        logits: Tensor = self.layers(features)[:, 0]
        return logits


class ReducedSimulator(nn.Module):
    """R: from contexts, measured and latent together, to the readings of all sensors.

    Args:
        contexts: number of contexts.
        sensors: number of sensors.
        width: of the hidden layers.
        ways: 2 if the structure answers differently to a train that goes backwards, else 1.
    """

    middle: Tensor
    unit: Tensor
    centre: Tensor
    scale: Tensor

    def __init__(self, contexts: int, sensors: int, width: int, ways: int) -> None:
        super().__init__()
        self.ways = ways
        self.register_buffer("middle", torch.zeros(contexts))
        self.register_buffer("unit", torch.ones(contexts))
        self.register_buffer("centre", torch.zeros(sensors))
        self.register_buffer("scale", torch.ones(sensors))
        self.curved = perceptron(contexts + ways - 1, width, sensors)
        self.linear = nn.Linear(contexts + ways - 1, sensors)

    def standard(self, contexts: Tensor, backwards: Tensor) -> Tensor:
        """Standardised readings, float[n, sensors], of rows that go backwards (1) or not (0)."""
        inputs = (contexts - self.middle) / self.unit
        if self.ways == 2:
            inputs = torch.cat([inputs, 2.0 * backwards[:, None] - 1.0], dim=1)
        readings: Tensor = self.curved(inputs) + self.linear(inputs)
        return readings

    def forward(self, contexts: Tensor) -> Tensor:
        """Readings in their units, float[ways, n, sensors]; the way backwards stands second."""
        contexts = contexts.to(self.middle.dtype)
        both = [
            self.standard(contexts, torch.full((len(contexts),), float(way)))
            for way in range(self.ways)
        ]
        return torch.stack(both) * self.scale + self.centre


def initialise(module: nn.Module, generator: torch.Generator) -> None:
    """Draw the weights of all linear layers from a generator of their own."""
    for layer in module.modules():
        if isinstance(layer, nn.Linear):
            bound = 1.0 / math.sqrt(layer.in_features)
            with torch.no_grad():
                layer.weight.uniform_(-bound, bound, generator=generator)
                layer.bias.uniform_(-bound, bound, generator=generator)


def start_from_line(layer: nn.Linear, inputs: Tensor, outputs: Tensor) -> None:
    """Set the first outputs of a linear layer to the least-squares map of inputs to outputs.

    Args:
        layer: whose first rows are set.
        inputs: float[n, in].
        outputs: float[n, k], k at most the number of outputs of the layer.
    """
    ones = torch.ones(len(inputs), 1, dtype=torch.float64)
    table = torch.cat([inputs.double(), ones], dim=1)
    # A little of the identity keeps channels that never vary at a weight of zero.
    square = table.T @ table + 1e-6 * len(table) * torch.eye(table.shape[1], dtype=torch.float64)
    weights = torch.linalg.solve(square, table.T @ outputs.double()).to(layer.weight.dtype)
    with torch.no_grad():
        layer.weight[: outputs.shape[1]] = weights[:-1].T
        layer.bias[: outputs.shape[1]] = weights[-1]


def telling_directions(channels: Tensor, noise: Tensor) -> Tensor:
    """The directions of channels that vary more than their noise, each scaled by how much it shows.

    Directions of about unit variance let a small network learn what hangs on small differences of
    large readings; one that holds noise alone is scaled to nothing.

    Args:
        channels: without noise, mean zero, float[n, channels].
        noise: standard deviation of each, float[channels].

    Returns:
        float[channels, channels], for channels to be multiplied with.
    """
    noise = noise.double().clamp(min=1e-3)
    ratio = channels.double() / noise
    variance, directions = torch.linalg.eigh(ratio.T @ ratio / len(ratio))
    variance = variance.clamp(min=0.0)
    scaled: Tensor = (directions / noise[:, None]) * (variance.sqrt() / (variance + 1.0))
    return scaled
