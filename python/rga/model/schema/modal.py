"""Natural frequencies and mode shapes as what is measured: points, modes and their sensors."""

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from rga.model.parameter import SMALLEST, AboveZero, Number
from rga.model.schema.parts import Part, Vector
from rga.no_booleans import NO_BOOLEAN

#: kinds of sensors that read modes
MODAL_KINDS = ("frequency", "mode_shape")
#: share of its frequency by which a mode may differ from what is expected, if nothing is said
USUAL_WITHIN = 0.15


class MeasuringPoint(Part):
    """A place at which shapes are measured, by an accelerometer, say.

    Attributes:
        direction: in which it measures; its length does not matter.
    """

    node: str
    direction: Vector

    @model_validator(mode="after")
    def _some_direction(self) -> "MeasuringPoint":
        if max(map(abs, self.direction)) < SMALLEST:
            raise ValueError(f"the direction {list(self.direction)} points nowhere")
        return self


class ExpectedMode(Part):
    """What a mode looks like: by its shape it is known, never by its number.

    Attributes:
        near: frequency about which it is expected [Hz].
        within: share of the frequency by which it may well differ.
        shape: its motion at points, to any scale.
        computed: in place of a shape: the mode of that number of the model as it stands, from 1.
        cluster: other modes with which it may trade names.
    """

    near: AboveZero
    within: Annotated[float, Field(gt=0, le=1), NO_BOOLEAN] = USUAL_WITHIN
    shape: dict[str, Number] = {}
    computed: Annotated[int, Field(ge=1, le=1000), NO_BOOLEAN] | None = None
    cluster: list[str] = []

    @model_validator(mode="after")
    def _one_look(self) -> "ExpectedMode":
        if self.shape and self.computed is not None:
            raise ValueError("a mode has a shape or is the one computed: give one of the two")
        if self.shape and max(map(abs, self.shape.values())) < SMALLEST:
            raise ValueError("the shape is zero at every point")
        return self


class ModalSensor(Part):
    """A natural frequency, or the shape of a mode at a point, as a channel.

    Attributes:
        kind: `frequency` [Hz], or `mode_shape` [-], to the scale of the mode's shape in the model.
        mode, point: names.
        noise: standard deviation of one reading [unit]; None: estimated.
    """

    kind: Literal["frequency", "mode_shape"]
    mode: str
    point: str | None = None
    unit: str
    noise: AboveZero | None = None
    groups: list[str] = []

    @model_validator(mode="after")
    def _complete(self) -> "ModalSensor":
        unit = "Hz" if self.kind == "frequency" else "-"
        if self.unit != unit:
            raise ValueError(f"the unit {self.unit!r} is not that of a {self.kind}; use {unit}")
        if self.kind == "mode_shape" and self.point is None:
            raise ValueError("a mode_shape sensor needs 'point'")
        if self.kind == "frequency" and self.point is not None:
            raise ValueError("a frequency has no 'point'")
        return self


def is_modal(sensor: Any) -> bool:
    """Whether a sensor, or what a file states of it, reads modes."""
    kind = sensor.get("kind") if isinstance(sensor, dict) else getattr(sensor, "kind", None)
    return kind in MODAL_KINDS
