"""What changes from record to record."""

from typing import Literal

from pydantic import model_validator

from rga.model.parameter import AboveZero, Number
from rga.model.schema.parts import Part


class ContextVariable(Part):
    """What changes from record to record.

    Attributes:
        range: prior of a latent variable, range of validity of a measured one.
        noise: standard deviation of its measurement; None: estimated.
        law: how a latent variable moves; rate bounds the law `linear` [unit/s].
    """

    unit: str
    range: tuple[Number, Number]
    noise: AboveZero | None = None
    law: Literal["independent", "constant", "linear", "smooth"] = "independent"
    rate: tuple[Number, Number] | None = None

    @model_validator(mode="after")
    def _ordered(self) -> "ContextVariable":
        if not self.range[0] < self.range[1]:
            raise ValueError(f"range {list(self.range)} must grow: [smallest, largest]")
        if self.law == "linear" and self.rate is None:
            raise ValueError("the law 'linear' needs a rate: [smallest, largest] per second")
        if self.noise and not 1e-12 <= self.noise / (self.range[1] - self.range[0]) <= 1e6:
            raise ValueError(f"a noise of {self.noise:g} is none beside the range: state another")
        return self
