"""Whether expected modes can be computed, are seen by the points, and are told apart."""

from collections.abc import Iterator

from rga.checking.finding import Finding, parts, refused
from rga.checking.of_model.mechanisms import unstable
from rga.checking.over_ranges import OverRanges
from rga.errors import InputError, UnstableStructureError
from rga.simulation import ModalSimulator
from rga.simulation.modal.looks import twin_modes, unseen_modes


def looks(over: OverRanges) -> Iterator[Finding]:
    """Modes that cannot be computed in the middle of the ranges, are not seen, or are one."""
    if not over.model.modes:
        return
    try:
        simulator = ModalSimulator(over.model)
        simulator.pair(over.middle)
    except InputError as error:
        if not isinstance(error, UnstableStructureError) or unstable(over) is None:
            yield from refused(error)
        return
    if unseen := unseen_modes(simulator.expected):
        yield Finding(
            "warning",
            parts("mode", unseen),
            "every point stands still in it: it is known by its frequency alone",
            "add points that it moves",
        )
    for pair in twin_modes(simulator.expected):
        yield Finding(
            "warning",
            parts("mode", pair),
            "they look the same by frequency and shape, and cannot be told apart",
            "leave one out, or add points at which they differ",
        )
