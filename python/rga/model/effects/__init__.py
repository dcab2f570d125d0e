"""The vocabulary of effects: loads, and the mechanisms that a diagnosis may propose."""

from rga.model.effects import (
    axles,
    bearings,
    contexts,
    creep,
    floor,
    joints,
    loading,
    loads,
    sensors,
    settlement,
    slack,
    stiffness,
    temperature,
    thermal,
)

__all__ = [
    "axles",
    "bearings",
    "contexts",
    "creep",
    "floor",
    "joints",
    "loading",
    "loads",
    "sensors",
    "settlement",
    "slack",
    "stiffness",
    "temperature",
    "thermal",
]
