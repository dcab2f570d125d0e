"""What effects that look back have kept of the rows so far, as of some of these rows."""

import json
from dataclasses import dataclass, replace

from rga.simulation import Memory

#: rows before those to follow from which on friction is found anew where the structure is another:
#: what rests in a bearing is forgotten by the next larger movement
ANEW = 1024
#: marks that are kept; of the older half every second is dropped when there are more
MARKS = 64


@dataclass(frozen=True)
class Mark:
    """What was kept before a row.

    Attributes:
        row: the row after the last that was followed.
        version: of the model.
        structure: tells what a calibration has found of it from what others have.
        memory: what was kept.
    """

    row: int
    version: int
    structure: str
    memory: Memory


class Memories:
    """Memories of a simulation, by row: rows can be followed again from one of them on."""

    def __init__(self) -> None:
        self._marks: list[Mark] = []

    def before(self, first: int, version: int, structure: str) -> tuple[int, Memory | None]:
        """The row to begin at so that rows from another on can be followed, and what to begin with.

        Args:
            first: of the rows to follow.
            version: of the model.
            structure: as a calibration has found it.
        """
        marks = [one for one in self._marks if one.row <= first and one.version == version]
        for mark in reversed(marks):
            if mark.structure == structure:
                return mark.row, mark.memory
        for mark in reversed(marks):
            if mark.row <= first - ANEW:
                return mark.row, replace(mark.memory, friction=Memory().friction)
        return 0, None

    def keep(self, first: int, mark: Mark) -> None:
        """Keep what was kept when rows from one on had been followed; older later ones go."""
        self._marks = [one for one in self._marks if one.row <= first]
        self._marks.append(mark)
        if len(self._marks) > MARKS:
            half = MARKS // 2
            self._marks = self._marks[:half:2] + self._marks[half:]

    def to_bytes(self) -> bytes:
        """All of them."""
        marks = [
            [one.row, one.version, one.structure, one.memory.to_bytes().decode()]
            for one in self._marks
        ]
        return json.dumps(marks).encode()

    def restore(self, state: bytes) -> None:
        """Go on where another stood."""
        self._marks = [
            Mark(row, version, structure, Memory.from_bytes(memory.encode()))
            for row, version, structure, memory in json.loads(state)
        ]
