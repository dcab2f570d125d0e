"""Rows of readings and contexts that a network learns from."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.variables import Variables


@dataclass(frozen=True)
class Samples:
    """Rows of one domain: simulated (the source, contexts known) or real (the target).

    Attributes:
        readings: float[n, sensors] in the sensors' units, NaN where missing.
        measured: measured contexts, float[n, measured] in their units, NaN where missing.
        latent: contexts to infer, float[n, latent]; None where they are not known.
        reversed: bool[n], rows in which a latent position stands for a train that goes backwards;
            None where that makes no difference or is not known.

    >>> len(Samples(np.zeros((3, 2)), np.zeros((3, 0))))
    3
    """

    readings: FloatArray
    measured: FloatArray
    latent: FloatArray | None = None
    reversed: NDArray[np.bool_] | None = None

    def __len__(self) -> int:
        return len(self.readings)

    @property
    def channels(self) -> FloatArray:
        """Readings, then measured contexts, float[n, sensors + measured]."""
        return np.concatenate([self.readings, self.measured], axis=1)

    def rows(self, chosen: NDArray[np.bool_] | NDArray[np.int64] | slice) -> "Samples":
        """Some of the rows."""
        return Samples(
            self.readings[chosen],
            self.measured[chosen],
            None if self.latent is None else self.latent[chosen],
            None if self.reversed is None else self.reversed[chosen],
        )

    def check(self, variables: Variables, where: str) -> None:
        """Refuse rows that do not fit the variables.

        Args:
            variables: sensors and contexts.
            where: what the samples are, for the message.

        Raises:
            InputError: a wrong shape, or a latent context that is not finite.
        """
        rows = len(self)
        wanted = {
            "readings": (self.readings, len(variables.sensors)),
            "measured": (self.measured, len(variables.measured)),
            "latent": (self.latent, len(variables.latent)),
        }
        for name, (table, columns) in wanted.items():
            if table is not None and table.shape != (rows, columns):
                remedy = f"give float[{rows}, {columns}]"
                raise InputError(f"{name} have the shape {list(table.shape)}", where, remedy)
        if self.latent is not None and not np.isfinite(self.latent).all():
            raise InputError("a latent context is not finite", where, "leave the row out")

    def known(self, variables: Variables, where: str) -> FloatArray:
        """The latent contexts of rows that have them, float[n, latent].

        Raises:
            InputError: the samples do not fit the variables, have no rows or no latent contexts.
        """
        self.check(variables, where)
        if self.latent is None or not len(self):
            raise InputError("there are no rows with known contexts", where, "simulate some")
        return self.latent
