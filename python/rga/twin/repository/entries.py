"""What a repository holds, as its readers return it."""

import hashlib
import json
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray

Rows = NDArray[np.int64]
Origin = Literal["design", "requested", "novel"]
Time = str | float


@dataclass(frozen=True)
class Identity:
    """What distinguishes one run from another: the same identity resumes, another begins anew.

    Attributes:
        model_sha256: hash of the model as given.
        source: where rows come from: the hash of a record, or "live:" and the name of a twin.
        seed: of the run, below 2^63.
        settings: JSON text of all else that the run's results depend on.

    >>> Identity("a", "b", 1, "{}").key == Identity("a", "b", 2, "{}").key
    False
    """

    model_sha256: str
    source: str
    seed: int
    settings: str

    @property
    def key(self) -> str:
        """SHA-256 of the identity, in hexadecimal digits."""
        parts = [self.model_sha256, self.source, self.seed, self.settings]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


@dataclass(frozen=True)
class StoredReadings:
    """Rows of the record.

    Attributes:
        rows: int[n], ascending.
        time: float[n] [s since the first row of the record].
        readings: float[n, sensors] in their units, NaN where a value is missing.
        contexts: measured contexts, float[n, measured], NaN where a value is missing.
    """

    rows: Rows
    time: FloatArray
    readings: FloatArray
    contexts: FloatArray


@dataclass(frozen=True)
class StoredSimulations:
    """Simulations in the order in which they were stored.

    Attributes:
        version: model version of each, int[n].
        origin: "design", "requested" or "novel" for each, str[n].
        row: row of the record at which each was stored, int[n].
        contexts: float[n, k] in their units.
        readings: float[n, sensors] in their units.
        falling: bool[n], those simulated with a latent position that falls: a train backwards.
    """

    version: Rows
    origin: NDArray[np.str_]
    row: Rows
    contexts: FloatArray
    readings: FloatArray
    falling: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.row)


@dataclass(frozen=True)
class Inferred:
    """Inferred contexts of rows of the record.

    Attributes:
        rows: int[n], ascending.
        contexts: posterior mean, float[n, k] in their units.
        spread: posterior standard deviation, float[n, k] in the same units.
        version: model version that each row was inferred under, int[n].
    """

    rows: Rows
    contexts: FloatArray
    spread: FloatArray
    version: Rows


@dataclass(frozen=True)
class StoredGaps:
    """Reality gaps of rows of the record.

    Attributes:
        rows: int[n], ascending.
        simulated: at the inferred contexts, float[n, sensors] in their units.
        gaps: squared differences of measured and simulated, float[n, sensors] [unit squared].
        version: model version that simulated each row, int[n].
    """

    rows: Rows
    simulated: FloatArray
    gaps: FloatArray
    version: Rows


@dataclass(frozen=True)
class StoredMessage:
    """A query or a response.

    Attributes:
        kind: "Q1" to "Q5", "R1" to "R5".
        row: row of the record at which it was sent.
        time: the same as the record writes time; None where it writes none.
        body: what it said.
        written_at: wall clock, UTC.
    """

    kind: str
    row: int
    time: Time | None
    body: dict[str, Any]
    written_at: datetime


@dataclass(frozen=True)
class ModelVersion:
    """A model version.

    Attributes:
        number: 1 for the model as it was given.
        row: row of the record at which it was stored.
        model: the model file's JSON text.
        model_sha256: its hash.
        causes: JSON text: the effects that it has beyond the model as given.
        gain: held-out gain of the diagnosis that proposed it, with its 90 % interval [-].
        status: what was decided about it when it was stored.
    """

    number: int
    row: int
    model: str
    model_sha256: str
    causes: str
    gain: float | None
    gain_ci90: tuple[float, float] | None
    status: str


@dataclass(frozen=True)
class StoredFindings:
    """Findings of a diagnosis, as JSON text, and the row of the record that it ended with."""

    row: int
    findings: str


@dataclass(frozen=True)
class Proposal:
    """A change of the model that a diagnosis proposes.

    Attributes:
        number: from 1.
        row: row of the record at which it was made.
        words: what the model would have then.
        effects: that the model would have beyond the one as given, as they stand in a model file.
        gain: on held-out rows, with its 90 % interval [-]; None where nothing was measured.
    """

    number: int
    row: int
    words: str
    effects: dict[str, dict[str, Any]]
    gain: float | None
    gain_ci90: tuple[float, float] | None


@dataclass(frozen=True)
class StoredCommand:
    """What somebody asked for, and what came of it.

    Attributes:
        row: row of the record at which it was carried out.
        kind: "accept", "reject", "rollback", "exclude", "recalibrate" or "note".
        body: what it was about.
        who, why: as they were given.
        given_at: wall clock, UTC, as ISO 8601 text.
        outcome: what came of it, in words.
    """

    row: int
    kind: str
    body: dict[str, Any]
    who: str
    why: str
    given_at: str
    outcome: str
