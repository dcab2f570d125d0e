"""The model: a structure as data, with its contexts, effects and sensors."""

from rga.model import effects as effects
from rga.model.effect import Effect
from rga.model.io import (
    as_model,
    load_model,
    model_content,
    model_of_text,
    read_model,
    write_model,
)
from rga.model.schema import ContextVariable, Model, Sensor, model_schema, read_effect

__all__ = [
    "ContextVariable",
    "Effect",
    "Model",
    "Sensor",
    "as_model",
    "load_model",
    "model_content",
    "model_of_text",
    "model_schema",
    "read_effect",
    "read_model",
    "write_model",
]
