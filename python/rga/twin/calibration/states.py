"""States of a twin that are kept, and taken up again when their conditions recur (level C)."""

import io
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Self
from zipfile import BadZipFile

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.expectation import (
    channel_bound,
    channel_medians,
    of_rows,
    usual_bound,
)
from rga.twin.calibration.learning import read, written
from rga.twin.novelty import beside
from rga.twin.simulation_model import SimulationModel


@dataclass(frozen=True, eq=False)
class State:
    """What infers contexts under some conditions, and what gap it leaves there.

    Attributes:
        estimator: what infers, with what it has found of structure and sensors.
        version: of the model that it is about.
        rows: (first, end) of the rows that it stands for.
        contexts: of these rows, float[rows, contexts].
        gaps: of these rows over the gap to expect, float[rows, channels], NaN where not known [-].
        doubted: the model is in doubt under these conditions: what was learned hides a change.
    """

    estimator: ContextEstimator
    version: int
    rows: tuple[int, int]
    contexts: FloatArray
    gaps: FloatArray
    doubted: bool = False

    def explains(
        self, contexts: FloatArray, gaps: FloatArray, optimism: float, share: float, seed: int
    ) -> bool:
        """Whether rows are like its own: in contexts, in their gap, and in that of each channel.

        Args:
            contexts: of the rows, float[n, contexts].
            gaps: of the rows over the gap to expect, float[n, channels].
            optimism: gap of rows that were not learned from, over that of its own rows [-].
            share: of stretches of its own rows that stay below the bounds.
            seed: of the stretches drawn.
        """
        by_row = of_rows(gaps)
        by_row = by_row[np.isfinite(by_row)]
        if not len(by_row) or np.mean(beside(contexts, self.contexts)) > 0.5:
            return False
        bound = usual_bound(of_rows(self.gaps), len(by_row), share, seed)
        if np.median(by_row) > optimism * bound:
            return False
        # A fault of one channel hardly shows in the mean of many.
        own, theirs = channel_medians(self.gaps), channel_medians(gaps)
        known = np.isfinite(theirs) & (own > 0)
        bound = channel_bound(self.gaps, len(by_row), share, seed)
        return bool(np.all(theirs[known] <= optimism * bound * own[known]))

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
        head = {"version": self.version, "rows": self.rows, "doubted": self.doubted}
        content = io.BytesIO()
        np.savez(
            content,
            allow_pickle=False,
            head=np.frombuffer(json.dumps(head).encode(), dtype=np.uint8),
            contexts=self.contexts,
            gaps=self.gaps,
            estimator=np.frombuffer(written(self.estimator), dtype=np.uint8),
        )
        return content.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes, simulation: Callable[[int], SimulationModel]) -> Self:
        """What `to_bytes` wrote.

        Args:
            content: it.
            simulation: the simulation model of a version, by its number.

        Raises:
            InputError: the bytes hold something else.
        """
        try:
            with np.load(io.BytesIO(content), allow_pickle=False) as kept:
                head, estimator, contexts, gaps = (
                    kept[name] for name in ("head", "estimator", "contexts", "gaps")
                )
        except (ValueError, KeyError, OSError, BadZipFile) as error:
            problem = "these bytes hold no state of a twin"
            raise InputError(problem, "stored state", "begin a new run") from error
        known = json.loads(head.tobytes())
        first, end = known["rows"]
        learned = read(estimator.tobytes(), simulation(known["version"]))
        return cls(learned, known["version"], (first, end), contexts, gaps, known["doubted"])
