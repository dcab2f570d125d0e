"""The simulator: contexts in, sensor values and results of the structure out."""

from rga.simulation.memory import Followed, Memory
from rga.simulation.modal_analysis import Modes, modes
from rga.simulation.simulator import Simulator
from rga.simulation.structural_results import Results, results

__all__ = ["Followed", "Memory", "Modes", "Results", "Simulator", "modes", "results"]
