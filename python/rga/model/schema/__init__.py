"""The model file, part by part."""

from rga.model.schema.context_variable import ContextVariable
from rga.model.schema.modal import ExpectedMode, MeasuringPoint, ModalSensor
from rga.model.schema.model_file import UNREAD, Analysis, Model, model_schema, read_effect
from rga.model.schema.parts import (
    DOFS,
    About,
    Dof,
    Ends,
    EndSprings,
    Mass,
    Material,
    Member,
    Section,
    Spring,
    Support,
    Tie,
    Vector,
)
from rga.model.schema.sensor import Sensor

__all__ = [
    "DOFS",
    "UNREAD",
    "About",
    "Analysis",
    "ContextVariable",
    "Dof",
    "EndSprings",
    "Ends",
    "ExpectedMode",
    "Mass",
    "Material",
    "MeasuringPoint",
    "Member",
    "ModalSensor",
    "Model",
    "Section",
    "Sensor",
    "Spring",
    "Support",
    "Tie",
    "Vector",
    "model_schema",
    "read_effect",
]
