"""Channels as loggers break them: a library of faults, and what a diagnosis makes of each."""

from .library import FAULTS, Fault, Scale

__all__ = ["FAULTS", "Fault", "Scale"]
