"""The arrays behind a diagnosis: what a report draws."""

from dataclasses import dataclass

from rga.diagnosis.row_covariance import BoolArray
from rga.model.parameter import FloatArray
from rga.model.schema import Model
from rga.records import Record


@dataclass(frozen=True)
class Account:
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
