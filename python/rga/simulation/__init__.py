"""The simulator: contexts in, sensor values and results of the structure out."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
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

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "Followed": "rga.simulation.memory",
    "Memory": "rga.simulation.memory",
    "ModalSimulator": "rga.simulation.modal.simulator",
    "Modes": "rga.simulation.modal.analysis",
    "Results": "rga.simulation.structural_results",
    "Simulator": "rga.simulation.simulator",
    "modes": "rga.simulation.modal.analysis",
    "results": "rga.simulation.structural_results",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
