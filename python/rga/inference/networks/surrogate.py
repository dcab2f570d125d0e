"""The reduced-order simulator: learned from the source once, frozen afterwards."""

from collections.abc import Callable

import torch

from rga.inference.networks.dataset import Samples
from rga.inference.networks.determinism import one_thread
from rga.inference.networks.layers import ReducedSimulator, initialise, start_from_line
from rga.inference.networks.schedule import falling
from rga.inference.networks.settings import TrainingSettings
from rga.inference.variables import Variables


def pretrain(
    source: Samples,
    variables: Variables,
    settings: TrainingSettings,
    *,
    seed: int,
    progress: Callable[[float], None] | None = None,
) -> ReducedSimulator:
    """Train a reduced-order simulator on simulated rows, and freeze it.

    Args:
        source: rows with known contexts and noise-free readings.
        variables: sensors and contexts.
        settings: `reduced_steps`, `reduced_width`, `batch` and `learning_rate` are used.
        seed: of weights and batches.
        progress: called with the share that is done.

    Returns:
        float[n, contexts] (in the order of the model) -> float[ways, n, sensors], in `eval` mode;
        no weight asks for a gradient.

    Raises:
        InputError: the samples do not fit the variables.
    """
    latent = source.known(variables, "source")
    with one_thread():
        generator = torch.Generator().manual_seed(seed)
        contexts = torch.from_numpy(variables.together(source.measured, latent)).float()
        readings = torch.from_numpy(source.readings).float()
        ways = 1 if source.reversed is None or not source.reversed.any() else 2
        backwards = torch.zeros(len(source))
        if source.reversed is not None:
            backwards = torch.from_numpy(source.reversed).float()
        reduced = ReducedSimulator(
            len(variables.contexts), len(variables.sensors), settings.reduced_width, ways
        )
        initialise(reduced, generator)
        reduced.middle.copy_(torch.from_numpy(variables.middle))
        reduced.unit.copy_(torch.from_numpy(variables.width / 2))
        reduced.centre.copy_(readings.mean(0))
        spread = readings.std(0)
        reduced.scale.copy_(torch.where(spread > 0, spread, 1.0))
        wanted = (readings - reduced.centre) / reduced.scale
        inputs = (contexts - reduced.middle) / reduced.unit
        if ways == 2:
            inputs = torch.cat([inputs, 2.0 * backwards[:, None] - 1.0], dim=1)
        start_from_line(reduced.linear, inputs, wanted)
        optimiser = torch.optim.Adam(reduced.parameters(), lr=settings.learning_rate, fused=True)
        for step in range(settings.reduced_steps):
            done = step / settings.reduced_steps
            for group in optimiser.param_groups:
                group["lr"] = settings.learning_rate * falling(done)
            chosen = torch.randint(len(source), (settings.batch,), generator=generator)
            optimiser.zero_grad()
            found = reduced.standard(contexts[chosen], backwards[chosen])
            torch.autograd.backward(torch.nn.functional.mse_loss(found, wanted[chosen]))
            optimiser.step()
            if progress is not None:
                progress((step + 1) / settings.reduced_steps)
    return reduced.requires_grad_(False).eval()
