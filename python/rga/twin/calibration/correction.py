"""What a calibration has found otherwise than the model says: structure and sensors."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, FiniteFloat

from rga.arrays import FloatArray
from rga.model import Model

if TYPE_CHECKING:
    from rga.inference import Joint


class Correction(BaseModel):
    """Structural parameters and errors of sensors, as one calibration has found them.

    It is no cause: it is what brings a model that is roughly right to the structure as built.

    Attributes:
        structure: structural parameters by their names (`rga.inference.Unknowns`), as found.
        gains: factor on what each sensor reads [-].
        offsets: what each sensor reads beside that [its unit], the logger's zero included.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    structure: dict[str, FiniteFloat]
    gains: dict[str, FiniteFloat]
    offsets: dict[str, FiniteFloat]

    @classmethod
    def of(cls, found: "Joint", zero: Mapping[str, float]) -> Self:
        """What a joint posterior has found.

        Args:
            found: it, of some of the sensors.
            zero: what the logger took off every sensor [its unit].
        """
        sensors = tuple(found.unknowns.model.sensors)
        gains = dict.fromkeys(zero, 1.0) | dict(zip(sensors, found.gains.tolist(), strict=True))
        offsets = dict(zip(sensors, found.offsets.tolist(), strict=True))
        parts = [part.name for part in found.unknowns.parts]
        return cls(
            structure=dict(zip(parts, found.values.tolist(), strict=True)),
            gains=gains,
            offsets={name: offsets.get(name, 0.0) - value for name, value in zero.items()},
        )

    def corrected(self, model: Model) -> Model:
        """The model with its structure as it was found."""
        from rga.inference import Unknowns

        unknowns = Unknowns(model)
        return unknowns.at(np.array([self.structure[part.name] for part in unknowns.parts]))

    def of_sensors(self, sensors: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
        """Gains and offsets of sensors, float[sensors] each."""
        gains = np.array([self.gains[name] for name in sensors])
        return gains, np.array([self.offsets[name] for name in sensors])
