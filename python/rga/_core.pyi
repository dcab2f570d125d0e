"""Finite elements for truss and frame bridges."""

from collections.abc import Sequence
from enum import IntEnum
from typing import Any, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rga.arrays import LoadArrays, MassArrays, OutputArrays, StructureArrays

__all__ = [
    "ChangeStatistics",
    "Condensation",
    "DependentTerms",
    "GaussianWindow",
    "InvalidInput",
    "Loaded",
    "ModalBatch",
    "ModalReanalysis",
    "NotConverged",
    "OutputKind",
    "Reanalysis",
    "Refactored",
    "StiffnessDifference",
    "UnstableSample",
    "UnstableStructure",
    "count_terms",
    "innovations",
    "instructions",
    "modal_energies",
    "modes",
    "respond",
    "respond_nonlinear",
    "slide",
]

class OutputKind(IntEnum):
    """Codes of what an output is; `help(respond)` says what each reads."""

    DISPLACEMENT = 0
    ROTATION = 1
    STRAIN = 2
    SECTION_FORCE = 3
    REACTION_FORCE = 4
    REACTION_MOMENT = 5
    END_FORCE = 6

class InvalidInput(ValueError):
    """An array is missing, malformed or out of range; the message names it."""

class UnstableStructure(ArithmeticError):
    """Part of the structure can move freely."""

    node: int
    """What moves most."""
    dof: int
    """Its direction: 0..5 for ux uy uz rx ry rz."""
    direction: list[float]
    """The motion of that node, six numbers of norm 1."""
    row: int
    """Of `Refactored` and `respond_nonlinear`: the row of the sample."""
    share: float | None
    """Of `respond_nonlinear`: the part of the load that is carried."""

class DependentTerms(ArithmeticError):
    """Elongations of members and springs that vary depend on each other, or are prescribed."""

class UnstableSample(ArithmeticError):
    """The stiffnesses of a sample leave no stable structure."""

    row: int
    """The row of the sample."""

class NotConverged(ArithmeticError):
    """Friction forces did not settle."""

    row: int
    """The row of the time series."""

def modal_energies(
    structure: StructureArrays, masses: MassArrays, shapes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Energies in shapes [c, n, 6]: strain [c, m + s], kinetic [c, m + n]."""

def modes(
    structure: StructureArrays, masses: MassArrays, count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Modes: eigenvalues [c], shapes [c, n, 6], participation [c, 3] and the mass [3]."""

def respond(
    structure: StructureArrays,
    loads: LoadArrays,
    outputs: OutputArrays,
) -> NDArray[np.float64]:
    """Linear static response [patterns, outputs]; `help(respond)` lists the arrays."""

def respond_nonlinear(
    structure: StructureArrays,
    loads: LoadArrays,
    outputs: OutputArrays,
    coefficients: NDArray[np.float64],
    threads: int = 1,
) -> NDArray[np.float64]:
    """Response [rows, outputs] of the deformed structure; `help(respond_nonlinear)` tells more."""

def slide(
    free_displacement: NDArray[np.float64],
    flexibility: NDArray[np.float64],
    normal_free: NDArray[np.float64],
    normal_influence: NDArray[np.float64],
    mu: NDArray[np.float64],
    before: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Coulomb friction forces [rows, bearings] of bearings through time, on from a row before."""

@final
class Condensation:
    """A structure of which few stiffnesses vary, or none; `help(Condensation)` tells the algebra.

    What varies is condensed onto r terms of rank one; samples are given by the stiffness of each
    member and spring that varies, e of them.
    """

    def __new__(
        cls,
        structure: StructureArrays,
        loads: LoadArrays,
        outputs: OutputArrays,
        members: NDArray[np.int64],
        springs: NDArray[np.int64],
        axial: bool = False,
    ) -> Self: ...
    @property
    def terms(self) -> int:
        """How many terms there are, r."""

    @property
    def stiffness(self) -> NDArray[np.float64]:
        """Of the terms in the structure as it is [r]."""

    @property
    def element(self) -> NDArray[np.int64]:
        """Place of each term among the members, then springs, that vary [r]."""

    @property
    def loaded(self) -> NDArray[np.float64]:
        """Outputs under unit loads [p, o]."""

    @property
    def stretched(self) -> NDArray[np.float64]:
        """Elongations of the terms under unit loads [p, r]."""

    @property
    def influence(self) -> NDArray[np.float64]:
        """Outputs under unit pseudo-forces [r, o]."""

    @property
    def unit(self) -> NDArray[np.float64]:
        """Elongations under unit pseudo-forces [r, r]."""

    def respond(
        self,
        coefficients: NDArray[np.float64],
        stiffness: NDArray[np.float64],
        threads: int = 1,
        out: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64]:
        """Outputs [n, o] of n samples."""

    def pseudo_forces(
        self,
        coefficients: NDArray[np.float64],
        size: NDArray[np.float64],
        stiffness: NDArray[np.float64],
        rod: NDArray[np.bool_],
    ) -> NDArray[np.float64]:
        """Beside terms with play or slack [n, r]."""

    def differentiate(
        self,
        coefficients: NDArray[np.float64],
        stiffness: NDArray[np.float64],
        coefficient_rates: NDArray[np.float64],
        stiffness_rates: NDArray[np.float64],
        threads: int = 1,
    ) -> NDArray[np.float64]:
        """Derivatives [n, o, c] along c directions, from rates [n, p, c] and [n, e, c]."""

    def pull_back(
        self,
        coefficients: NDArray[np.float64],
        stiffness: NDArray[np.float64],
        gradients: NDArray[np.float64],
        threads: int = 1,
    ) -> NDArray[np.float64]:
        """Gradients [n, p + e] of outputs times gradients [n, o]: the adjoint."""

@final
class Reanalysis:
    """A structure solved once, and those near it; `help(Reanalysis)` tells more."""

    def __new__(cls, structure: StructureArrays, outputs: OutputArrays) -> Self: ...
    def under(self, loads: LoadArrays) -> Loaded:
        """The structure under loads."""

    def differing(
        self, structure: StructureArrays, outputs: OutputArrays
    ) -> StiffnessDifference | None:
        """Where stiffnesses differ; None where more than few stiffnesses do."""

    def changed(
        self,
        loaded: Loaded,
        structure: StructureArrays,
        difference: StiffnessDifference,
    ) -> NDArray[np.float64]:
        """Outputs [p, o] of a structure near this one under loads."""

    def onto(
        self, loaded: Loaded, members: NDArray[np.int64], springs: NDArray[np.int64]
    ) -> Condensation | None:
        """The structure under loads condensed along members and onto springs."""

    def rates(self, loaded: Loaded) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Members [k], and derivatives [k, p, o] of the outputs by the logarithm of their EA."""

@final
class ModalBatch:
    """Modes of samples whose stiffnesses vary; `help(ModalBatch)` tells more."""

    def __new__(
        cls,
        structure: StructureArrays,
        masses: MassArrays,
        varied: NDArray[np.int64],
        count: int,
        dofs: NDArray[np.int64],
        instructions: str | None = None,
    ) -> Self: ...
    def modes(
        self, factors: NDArray[np.float64], threads: int = 1
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Eigenvalues [k, c] and shapes [k, c, d] of samples, from factors [k, e]."""

@final
class ModalReanalysis:
    """A structure whose modes are known, and those near it; `help(ModalReanalysis)` tells more."""

    def __new__(cls, structure: StructureArrays, masses: MassArrays, count: int) -> Self: ...
    def modes(
        self, structure: StructureArrays, masses: MassArrays, count: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Modes of a structure near this one, as by `modes`."""

    def modes_below(
        self,
        structure: StructureArrays,
        masses: MassArrays,
        square: float,
        least: int,
        most: int,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Those below a square of the circular frequency, and the next."""

@final
class Loaded:
    """What load patterns do to the structure of a `Reanalysis`."""

    @property
    def outputs(self) -> NDArray[np.float64]:
        """Outputs [p, o]."""

    def choose(self, other: Loaded | None, places: Sequence[int]) -> Loaded:
        """Patterns of this and of another behind it, by their places."""

@final
class StiffnessDifference:
    """Where the stiffness of a structure differs from that of a `Reanalysis`."""

    def __bool__(self) -> bool:
        """Whether anything differs."""

@final
class Refactored:
    """Samples of a structure of which every stiffness may vary; `help(Refactored)` tells more."""

    def __new__(
        cls,
        structure: StructureArrays,
        loads: LoadArrays,
        outputs: OutputArrays,
        instructions: str | None = None,
    ) -> Self: ...
    def respond(
        self,
        factors: NDArray[np.float64],
        coefficients: NDArray[np.float64],
        threads: int = 1,
    ) -> NDArray[np.float64]:
        """Outputs [n, o] of n samples; 0 as a factor removes a member or spring."""

    def differentiate(
        self,
        factors: NDArray[np.float64],
        coefficients: NDArray[np.float64],
        elements: NDArray[np.int64],
        factor_rates: NDArray[np.float64],
        coefficient_rates: NDArray[np.float64],
        threads: int = 1,
    ) -> NDArray[np.float64]:
        """Derivatives [n, o, c] along c directions, from rates [n, e, c] and [n, p, c]."""

    def pull_back(
        self,
        factors: NDArray[np.float64],
        coefficients: NDArray[np.float64],
        gradients: NDArray[np.float64],
        threads: int = 1,
    ) -> NDArray[np.float64]:
        """Gradients [n, p + elements] of outputs times gradients [n, o]: the adjoint."""

@final
class ChangeStatistics:
    """Statistics of change over a stream; `rga.detection.SyncMonitor` is made of them."""

    def __new__(
        cls,
        reference: dict[str, NDArray[np.float64]],
        largest: float,
        thresholds: Sequence[float],
        rows_kept: int,
    ) -> Self: ...
    def update_many(self, rows: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether an alarm stands after each of the rows float[n, sensors]: bool[n]."""

    def take_peaks(self) -> NDArray[np.float32]:
        """The largest value of each statistic since this was last asked."""

    def recent(self) -> NDArray[np.float32]:
        """Scores of the latest rows since the statistics began, or of those around the alarm.

        float32[rows, sensors]
        """

    @property
    def recent_first(self) -> int:
        """Row of the stream that the first of these rows is."""

    def begin_again(self) -> None:
        """Forget the alarm and all evidence."""

    @property
    def rows(self) -> int:
        """Rows seen."""

    @property
    def alarm(self) -> tuple[int, int] | None:
        """Row of the stream that raised the alarm that stands, and number of the statistic."""

    def to_bytes(self) -> bytes:
        """The whole state: what `from_bytes` makes of it goes on with the same bits."""

    @classmethod
    def from_bytes(cls, state: bytes) -> Self:
        """The statistics that `to_bytes` stored; InputError for other bytes."""

@final
class GaussianWindow:
    """A Gaussian bound for each sensor, on a stream; `help(GaussianWindow)` tells the rule."""

    def __new__(
        cls,
        n_sensors: int,
        window: int,
        z: float | None = None,
        *,
        confidence: float | None = None,
        inclusive: bool = False,
        persistence: tuple[int, int] = (1, 1),
        frozen: bool = False,
    ) -> Self: ...
    def update(self, row: ArrayLike) -> NDArray[np.bool_]:
        """Alarms bool[n_sensors] of one row float[n_sensors]."""

    def update_many(self, rows: ArrayLike) -> NDArray[np.bool_]:
        """Alarms bool[n, n_sensors] of rows float[n, n_sensors], bit for bit those of `update`."""

    @property
    def bound(self) -> NDArray[np.float64]:
        """What the next row must exceed, float[n_sensors]; NaN until the window is full."""

    @property
    def rows(self) -> int:
        """Rows seen."""

    def to_bytes(self) -> bytes:
        """The whole state: what `from_bytes` makes of it goes on with the same bits."""

    @classmethod
    def from_bytes(cls, state: bytes) -> Self:
        """The window that `to_bytes` stored; InputError for other bytes."""

    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...

def count_terms(
    structure: StructureArrays,
    outputs: OutputArrays,
    members: NDArray[np.int64],
    springs: NDArray[np.int64],
) -> int:
    """How many terms of rank one vary with members and springs."""

def instructions() -> list[str]:
    """Instruction sets that `Refactored` can solve samples with here, the best first."""

def innovations(
    deviations: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """What deviations differ by from what those before let expect, to one variance.

    float[rows, sensors] from float[rows, sensors], NaN where missing, and weights of earlier
    deviations, the latest first, float[order, sensors]. Behind a gap less is known beforehand, and
    the difference is drawn in by as much.
    """
