"""The arrays behind a diagnosis: what a report draws."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.model.effect import Values
from rga.model.effects.sensors.sensor_fault import SensorFault
from rga.model.schema import Model
from rga.records import Record

if TYPE_CHECKING:
    from rga.diagnosis.search.stepwise import Found


@dataclass(frozen=True)
class DiagnosisArrays:
    """What was measured and what was simulated.

    Attributes:
        model: as it was given.
        extended: with the causes that were found.
        record: the rows that were analysed.
        held_out: rows that no step saw, bool[rows].
        rejected: bool[sensors], channels that do not work.
        before: simulation of the model, float[rows, sensors of the record].
        after: simulation of the extended model, the same shape.
        sigma: standard deviation of the noise of each sensor [its unit], float[sensors].
        noise: noise that a faultless simulation would still show, contexts' errors included,
            float[rows, sensors].
        contexts: as the extended model believes them, `time` [s] included, float[rows] each.
        recorded: rows of the record as it was given, of which those of `record` were analysed; 0
            where that is not known.
        found: the end of the search, from which the grounds of the findings are worked out when
            they are asked for; None where nothing was searched.
    """

    model: Model
    extended: Model
    record: Record
    held_out: BoolArray
    rejected: BoolArray
    before: FloatArray
    after: FloatArray
    sigma: FloatArray
    noise: FloatArray
    contexts: Values = field(default_factory=dict)
    found: "Found | None" = None
    recorded: int = 0

    @property
    def since(self) -> int:
        """The first row in which a cause acts; 0 without a cause that begins late."""
        causes = [
            effect
            for name, effect in self.extended.effects.items()
            if name not in self.model.effects and not isinstance(effect, SensorFault)
        ]
        clock = self.record.origin + self.record.time
        acts = np.array([effect.weight(clock) > 0 for effect in causes]).reshape(
            len(causes), len(clock)
        )
        return int(np.argmax(acts.any(0))) if acts.any() else 0
