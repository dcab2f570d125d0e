"""A structure as arrays: what effects change and what the core solves."""

from rga.model.structure.structure import (
    OF_MEMBERS,
    Bearing,
    Law,
    Load,
    Spread,
    Structure,
    build_structure,
    check_direction,
    unit_vector,
)

__all__ = [
    "OF_MEMBERS",
    "Bearing",
    "Law",
    "Load",
    "Spread",
    "Structure",
    "build_structure",
    "check_direction",
    "unit_vector",
]
