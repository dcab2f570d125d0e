"""The trained network: encoder and context predictor, and nothing else."""

import json

import numpy as np
import torch
from safetensors.torch import load, save
from torch import Tensor, nn

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.laws.mixture import Candidates
from rga.inference.networks.determinism import one_thread
from rga.inference.networks.layers import ContextPredictor, Encoder, Mixture
from rga.inference.networks.losses import REACH
from rga.inference.variables import Variables

FORMAT = "rga context network 1"


class ContextNetwork:
    """Infers latent contexts from rows of readings and measured contexts.

    Args:
        variables: sensors and contexts.
        width, features: sizes of the layers.
        modes: number of candidates a row, for each way.
        ways: 2 if a train may go backwards, else 1.
    """

    def __init__(
        self, variables: Variables, width: int, features: int, modes: int, ways: int
    ) -> None:
        self.variables = variables
        self.width, self.features, self.modes, self.ways = width, features, modes, ways
        channels, latent = len(variables.sensors) + len(variables.measured), len(variables.latent)
        self.encoder = Encoder(channels, width, features)
        self.predictor = ContextPredictor(features, width, latent, modes, ways)
        chosen = variables.latent_columns
        self._middle = torch.from_numpy(variables.middle[chosen])
        self._unit = torch.from_numpy(variables.width[chosen] / np.sqrt(12.0))

    def infer(self, readings: FloatArray, measured: FloatArray) -> FloatArray:
        """The most probable latent contexts.

        Args:
            readings: float[n, sensors] in the order of the model, NaN where missing.
            measured: measured contexts, float[n, measured], NaN where missing.

        Returns:
            float[n, latent] in their units; they leave their ranges by a quarter of their width
            at most, beyond which no training looks.

        Raises:
            InputError: a table of another shape.
        """
        return self.candidates(readings, measured).best()[0]

    def candidates(self, readings: FloatArray, measured: FloatArray) -> Candidates:
        """All candidates of every row, with spreads and probabilities; takes what `infer` takes."""
        mixture = self._answer(readings, measured)
        return Candidates(
            self.physical(mixture.value.clamp(-REACH, REACH)).numpy(),
            (mixture.log_spread.double().exp() * self._unit).numpy(),
            mixture.log_share.double().exp().numpy(),
            np.arange(mixture.log_share.shape[1]) % self.ways == 1,
        )

    def standard(self, latent: Tensor) -> Tensor:
        """Contexts in standard units: mean 0 and variance 1 when spread evenly over the range."""
        return ((latent - self._middle) / self._unit).float()

    def physical(self, standard: Tensor) -> Tensor:
        """Contexts in their units, float64[n, latent]."""
        return standard.double() * self._unit + self._middle

    def freeze(self) -> None:
        """Inference only: no weight asks for a gradient."""
        for part in (self.encoder, self.predictor):
            part.requires_grad_(False).eval()

    def thaw(self) -> None:
        """Weights may be trained further."""
        for part in (self.encoder, self.predictor):
            part.requires_grad_(True)

    def to_bytes(self) -> bytes:
        """Weights, scaling and names as a safetensors file."""
        variables = self.variables
        metadata = {
            "format": FORMAT,
            "sensors": variables.sensors,
            "contexts": variables.contexts,
            "latent": variables.latent,
            "ranges": variables.ranges,
            "sizes": [self.width, self.features, self.modes, self.ways],
        }
        # The header of the format is written in no fixed order: all of it goes into one entry.
        return save(self._modules().state_dict(), {"network": json.dumps(metadata)})

    @classmethod
    def from_bytes(cls, content: bytes) -> "ContextNetwork":
        """A network from what `to_bytes` wrote, bit for bit.

        Raises:
            InputError: the bytes hold something else.
        """
        try:
            length = int.from_bytes(content[:8], "little")
            header = json.loads(content[8 : 8 + length])["__metadata__"]
            metadata = json.loads(header["network"])
            if metadata["format"] != FORMAT:
                raise ValueError(metadata["format"])
            variables = Variables(
                sensors=tuple(metadata["sensors"]),
                contexts=tuple(metadata["contexts"]),
                latent=tuple(metadata["latent"]),
                ranges=tuple((low, high) for low, high in metadata["ranges"]),
            )
            network = cls(variables, *metadata["sizes"])
            network._modules().load_state_dict(load(content))
        except Exception as error:
            raise InputError(
                "these bytes hold no context network", "stored network", "train it again"
            ) from error
        network.freeze()
        return network

    def _modules(self) -> nn.ModuleDict:
        return nn.ModuleDict({"encoder": self.encoder, "predictor": self.predictor})

    def _answer(self, readings: FloatArray, measured: FloatArray) -> Mixture:
        wanted = {"readings": len(self.variables.sensors), "measured": len(self.variables.measured)}
        for (name, columns), table in zip(wanted.items(), (readings, measured), strict=True):
            if table.ndim != 2 or table.shape[1] != columns or len(table) != len(readings):
                raise InputError(
                    f"{name} have the shape {list(table.shape)}",
                    "context inference",
                    f"give float[{len(readings)}, {columns}]",
                )
        channels = torch.from_numpy(np.concatenate([readings, measured], axis=1)).float()
        with one_thread(), torch.no_grad():
            mixture: Mixture = self.predictor(self.encoder(channels))
            return mixture
