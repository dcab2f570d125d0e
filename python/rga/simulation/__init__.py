"""The simulator: contexts in, sensor values out."""

from rga.simulation.simulator import Simulator

__all__ = ["Simulator"]
