"""The simulator: contexts in, sensor values and results of the structure out."""

from rga.simulation.memory import Followed, Memory
from rga.simulation.modal.analysis import Modes, modes
from rga.simulation.modal.simulator import ModalSimulator
from rga.simulation.simulator import Simulator
from rga.simulation.structural_results import Results, results

__all__ = [
    "Followed",
    "Memory",
    "ModalSimulator",
    "Modes",
    "Results",
    "Simulator",
    "modes",
    "results",
]
