"""Where bearings with friction stand after the rows so far."""

from dataclasses import dataclass, field

import numpy as np

from rga.arrays import FloatArray, IntArray


@dataclass
class FrictionPast:
    """Where bearings stand in each structure that there has been; rows go on from it.

    Attributes:
        changes: how often the structure has changed from one row to the next.
        last: structural parameters of the last row, float[parameters]; None before the first.
        rested: by structural parameters, the motion without friction of each bearing [m], then its
            friction force [N], in the last row with that structure, float[2, bearings].
    """

    changes: int = 0
    last: FloatArray | None = None
    rested: dict[tuple[float, ...], FloatArray] = field(default_factory=dict)

    def copy(self) -> "FrictionPast":
        """Another for rows to change."""
        return FrictionPast(self.changes, self.last, dict(self.rested))

    def pass_through(self, states: FloatArray, state_of_row: IntArray) -> None:
        """Count changes of the structure.

        Args:
            states: structural parameters, float[states, parameters].
            state_of_row: of the rows that follow, int[rows].

        >>> past = FrictionPast()
        >>> past.pass_through(np.array([[1.0], [2.0]]), np.array([0, 1, 1]))
        >>> past.pass_through(np.array([[1.0]]), np.array([0]))
        >>> past.changes
        2
        """
        self.changes += int(np.count_nonzero(np.diff(state_of_row)))
        if self.last is not None:
            self.changes += not np.array_equal(self.last, states[state_of_row[0]])
        self.last = states[state_of_row[-1]].copy()
