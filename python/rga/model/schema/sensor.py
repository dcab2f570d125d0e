"""What is measured, and where."""

from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from rga.model.effect import check_moment, seconds
from rga.model.parameter import SMALLEST, AboveZero, AnyNumber, Number
from rga.model.schema.parts import Part, Vector
from rga.model.units import UNITS
from rga.no_booleans import NO_BOOLEAN


class Sensor(Part):
    """A sensor; `direction` for displacement, rotation and reaction, `member` for strain and force.

    Attributes:
        at: place along the member, 0..1; y, z: fibre of a frame member [m].
        total: a strain that contains thermal expansion.
        zero: the logger's mean over this time was taken off.
        noise: standard deviation of one reading [unit]; None: estimated.
    """

    kind: Literal["displacement", "rotation", "strain", "force", "reaction"]
    unit: str
    node: str | None = None
    direction: Vector | None = None
    relative_to: str | None = None
    member: str | None = None
    at: Annotated[float, Field(ge=0, le=1), NO_BOOLEAN] = 0.5
    y: Number = 0.0
    z: Number = 0.0
    total: bool = False
    zero: tuple[AnyNumber | str, AnyNumber | str] | None = None
    noise: AboveZero | None = None
    groups: list[str] = []

    @field_validator("zero")
    @classmethod
    def _times(
        cls, zero: tuple[float | str, float | str] | None
    ) -> tuple[float | str, float | str] | None:
        for moment in zero or ():
            check_moment(moment)
        if zero and seconds(zero[1]) < seconds(zero[0]):
            raise ValueError("the times run backwards: give [from, to]")
        return zero

    @model_validator(mode="after")
    def _complete(self) -> "Sensor":
        if self.unit not in UNITS[self.kind]:
            raise ValueError(
                f"the unit {self.unit!r} is not one of a {self.kind} sensor; use "
                + ", ".join(UNITS[self.kind])
            )
        if self.kind in ("strain", "force"):
            if self.member is None:
                raise ValueError(f"a {self.kind} sensor needs 'member'")
        elif self.node is None or self.direction is None:
            lacking = [name for name in ("node", "direction") if getattr(self, name) is None]
            raise ValueError(f"a {self.kind} sensor needs {' and '.join(map(repr, lacking))}")
        elif max(map(abs, self.direction)) < SMALLEST:
            raise ValueError(f"the direction {list(self.direction)} points nowhere")
        return self
