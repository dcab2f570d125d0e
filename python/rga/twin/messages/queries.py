"""Queries and responses: all that passes between the analysis, the twin and the repository.

The names are those of the paper: Q1 and R1 ask whether the twin can represent what a calibration
needs, Q2 and R2 whether the repository holds simulations, Q3 and R3 ask for the missing ones,
Q4 and R4 for the data set to learn from, Q5 and R5 send a context and bring what the twin simulates
there. Arrays are not written into the log: a hash stands for them, and the repository keeps them.
A message read from the log has none.
"""

import hashlib
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, TypeAdapter, model_validator

from rga.arrays import FloatArray
from rga.simulation import Memory
from rga.twin.calibration.correction import Correction

Rows = Annotated[int, Field(ge=0)]
Flags = NDArray[np.bool_]
VersionNumber = Annotated[int, Field(ge=1)]
Hash = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


def _no_rows() -> FloatArray:
    return np.zeros((0, 0))


def _no_flags() -> Flags:
    return np.zeros(0, dtype=np.bool_)


class Message(BaseModel):
    """A query or a response; `row` is the row of the record at which it was sent."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True)
    row: Rows


class Box(BaseModel):
    """A box of contexts, in the order of the model's context variables."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    low: tuple[FiniteFloat, ...]
    high: tuple[FiniteFloat, ...]

    @model_validator(mode="after")
    def _ordered(self) -> "Box":
        if len(self.low) != len(self.high):
            raise ValueError(f"{len(self.low)} lower ends but {len(self.high)} upper ends")
        if any(high < low for low, high in zip(self.low, self.high, strict=True)):
            raise ValueError("an upper end lies below its lower end")
        return self


class Q1(Message):
    """Can the twin represent what a calibration on these channels needs?

    Attributes:
        channels: sensors that send readings.
        measured: context variables that are measured.
        effects: with an update of the model: the effects that it is to have beyond the model as
            given, as they stand in a model file; None: the model stays.
        gain, gain_ci90: of that update on held-out rows, as the diagnosis found it [-].
        restore: with a rollback: the version to return to.
        correction: with a calibration: what it has found of structure and sensors.
    """

    kind: Literal["Q1"] = "Q1"
    channels: tuple[str, ...]
    measured: tuple[str, ...]
    effects: dict[str, dict[str, Any]] | None = None
    gain: FiniteFloat | None = None
    gain_ci90: tuple[FiniteFloat, FiniteFloat] | None = None
    restore: VersionNumber | None = None
    correction: Correction | None = None

    @model_validator(mode="after")
    def _one_change(self) -> "Q1":
        changes = (self.effects, self.restore, self.correction)
        if sum(one is not None for one in changes) > 1:
            raise ValueError("an update, a rollback or a correction, one at a time")
        return self


class R1(Message):
    """What the twin can represent, and the version that it holds from now on.

    Attributes:
        version: number of the model version.
        effects: its effects beyond the model as given.
        correction: of its structure and of the sensors; None where no calibration has found any.
        adequate: whether a calibration can go on.
        missing: what the model lacks, in words.
        latent: context variables to infer.
        blind: latent ones that no channel sees: they stay in the middle of their range.
    """

    kind: Literal["R1"] = "R1"
    version: VersionNumber
    effects: dict[str, dict[str, Any]]
    correction: Correction | None = None
    adequate: bool
    missing: tuple[str, ...]
    latent: tuple[str, ...]
    blind: tuple[str, ...]


class Q2(Message):
    """Does the repository hold simulations of this version within a box of contexts?"""

    kind: Literal["Q2"] = "Q2"
    version: VersionNumber
    box: Box
    wanted: Rows


class R2(Message):
    """How many it holds, and how many are missing."""

    kind: Literal["R2"] = "R2"
    held: Rows
    missing: Rows


class Q3(Message):
    """Simulate contexts drawn from a box, at a time [s] that effects with an onset go by."""

    kind: Literal["Q3"] = "Q3"
    version: VersionNumber
    box: Box
    clock: FiniteFloat
    rows: Annotated[int, Field(ge=1)]
    origin: Literal["design", "requested"]
    seed: Rows


class R3(Message):
    """The simulations asked for.

    Attributes:
        contexts, readings: float[n, contexts], float[n, channels].
        falling: bool[n], rows simulated with a latent position that falls (a train backwards).
    """

    kind: Literal["R3"] = "R3"
    version: VersionNumber
    origin: Literal["design", "requested"]
    contexts: FloatArray = Field(default_factory=_no_rows, exclude=True)
    readings: FloatArray = Field(default_factory=_no_rows, exclude=True)
    falling: Flags = Field(default_factory=_no_flags, exclude=True)
    sha256: Hash


class Q4(Message):
    """The data set to learn from: all simulations of a version, and measured rows.

    Attributes:
        measured: (first, end) of blocks of rows.
    """

    kind: Literal["Q4"] = "Q4"
    version: VersionNumber
    measured: tuple[tuple[Rows, Rows], ...]


class R4(Message):
    """The data set.

    Attributes:
        simulation: the simulation model of that version, to learn physics from.
        contexts, readings, falling: as of R3.
        real, real_contexts: measured, float[m, channels], float[m, measured contexts]; NaN where
            a value is missing.
    """

    kind: Literal["R4"] = "R4"
    simulation: Any = Field(default=None, exclude=True)
    contexts: FloatArray = Field(default_factory=_no_rows, exclude=True)
    readings: FloatArray = Field(default_factory=_no_rows, exclude=True)
    falling: Flags = Field(default_factory=_no_flags, exclude=True)
    real: FloatArray = Field(default_factory=_no_rows, exclude=True)
    real_contexts: FloatArray = Field(default_factory=_no_rows, exclude=True)
    simulated_rows: Rows
    measured_rows: Rows
    sha256: Hash


class Q5(Message):
    """The contexts of rows of the record: what does the twin simulate there?

    Attributes:
        first: first of the rows.
        time: clock of the rows [s], float[n].
        contexts: float[n, contexts], in the order of the model.
        time_before, contexts_before: the same of earlier rows: of those behind the memory, or of
            the last.
        memory: what effects that look back have kept of the rows before all these; None: nothing.
        unknown: rows of which a measured context is missing, whose readings are not simulated,
            bool[n]; of no length where there is none.
    """

    kind: Literal["Q5"] = "Q5"
    version: VersionNumber
    first: Rows
    rows: Annotated[int, Field(ge=1)]
    sha256: Hash
    time: FloatArray = Field(default_factory=_no_rows, exclude=True)
    contexts: FloatArray = Field(default_factory=_no_rows, exclude=True)
    time_before: FloatArray = Field(default_factory=_no_rows, exclude=True)
    contexts_before: FloatArray = Field(default_factory=_no_rows, exclude=True)
    memory: Memory | None = Field(default=None, exclude=True)
    unknown: Flags = Field(default_factory=_no_flags, exclude=True)


class R5(Message):
    """What the twin simulates at these contexts; the twin now stands at the last of them.

    Attributes:
        context: of the last row.
        simulated: float[n, channels], NaN in rows that were unknown.
        memory: with which the next rows are simulated; None: nothing looks back.
    """

    kind: Literal["R5"] = "R5"
    version: VersionNumber
    first: Rows
    rows: Annotated[int, Field(ge=1)]
    context: dict[str, float]
    sha256: Hash
    simulated: FloatArray = Field(default_factory=_no_rows, exclude=True)
    memory: Memory | None = Field(default=None, exclude=True)


Query = Q1 | Q2 | Q3 | Q4 | Q5
Response = R1 | R2 | R3 | R4 | R5


def sha256(*arrays: NDArray[Any]) -> str:
    """Hash of arrays, their shapes included.

    >>> sha256(np.zeros(2)) == sha256(np.zeros((2, 1)))
    False
    """
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(str(array.shape).encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()


_ADAPTER: TypeAdapter[Query | Response] = TypeAdapter(
    Annotated[Query | Response, Field(discriminator="kind")]
)


def read_message(kind: str, row: int, body: dict[str, Any]) -> Query | Response:
    """A message from the log, without its arrays.

    Raises:
        pydantic.ValidationError: it is none.
    """
    return _ADAPTER.validate_python({"kind": kind, "row": row, **body})
