"""States of a twin that are kept, and taken up again when their conditions recur (level C)."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np

from rga.arrays import FloatArray
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.expectation import usual_bound
from rga.twin.calibration.learning import read, written
from rga.twin.simulation_model import SimulationModel


@dataclass(frozen=True)
class State:
    """What infers contexts under some conditions, and what gap it leaves there.

    Attributes:
        estimator: what infers, with what it has found of structure and sensors.
        version: of the model that it is about.
        rows: (first, end) of the rows that it stands for.
        gaps: of each of these rows over the gap to expect, float[rows], NaN where not known [-].
        doubted: the model is in doubt under these conditions: what was learned hides a change.
    """

    estimator: ContextEstimator
    version: int
    rows: tuple[int, int]
    gaps: FloatArray
    doubted: bool = False

    def bound(self, rows: int, share: float, seed: int) -> float:
        """What the gap of so many rows stays below under its conditions [-].

        Args:
            rows: how many.
            share: of such stretches of its own rows that stay below.
            seed: of the stretches drawn.
        """
        return usual_bound(self.gaps, rows, share, seed)

    def taken_up(self, first: int, end: int) -> str:
        """In words, that it is in force again, as rows are like its own.

        Args:
            first, end: of the rows.
        """
        begun, ended = self.rows
        words = (
            f"rows {first} to {end - 1} are as rows {begun} to {ended - 1} were: what had been "
            "learned from these is in force again"
        )
        return words + (", and the model is in doubt as it was there" if self.doubted else "")

    def to_bytes(self) -> bytes:
        """As a repository keeps it."""
        head = {
            "version": self.version,
            "rows": self.rows,
            "gaps": self.gaps.tolist(),
            "doubted": self.doubted,
        }
        return json.dumps(head).encode() + b"\n" + written(self.estimator)

    @classmethod
    def from_bytes(cls, content: bytes, simulation: Callable[[int], SimulationModel]) -> Self:
        """What `to_bytes` wrote.

        Args:
            content: it.
            simulation: the simulation model of a version, by its number.

        Raises:
            InputError: the bytes hold something else.
        """
        head, _, estimator = content.partition(b"\n")
        known = json.loads(head)
        first, end = known["rows"]
        learned = read(estimator, simulation(known["version"]))
        gaps = np.array(known["gaps"], dtype=float)
        return cls(learned, known["version"], (first, end), gaps, known["doubted"])
