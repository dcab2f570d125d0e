"""Which quantities a network sees and which it infers."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.schema import Model


@dataclass(frozen=True)
class Variables:
    """Sensors and contexts of a model, and which of the contexts nothing measures.

    Attributes:
        sensors: names, in the order of the model.
        contexts: names of all context variables, in the order of the model.
        latent: those of them that are inferred, in the same order.
        ranges: (smallest, largest) of each of `contexts`, in its unit.

    >>> some = Variables(("D1",), ("temperature", "crowd"), ("crowd",), ((-20.0, 40.0), (0.0, 5.0)))
    >>> some.measured
    ('temperature',)
    >>> some.together(np.array([[7.0]]), np.array([[2.5]]))
    array([[7. , 2.5]])
    """

    sensors: tuple[str, ...]
    contexts: tuple[str, ...]
    latent: tuple[str, ...]
    ranges: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, model: Model, latent: Sequence[str]) -> "Variables":
        """The variables of a model.

        Args:
            model: with sensors and context variables.
            latent: context variables that are to be inferred.

        Raises:
            InputError: nothing to infer, nothing to infer it from, or an unknown context.
        """
        where = f"model {model.name!r}"
        if unknown := [name for name in latent if name not in model.context]:
            raise InputError(
                f"the model has no context variable {unknown[0]!r}",
                where,
                "it has " + (", ".join(model.context) or "none"),
            )
        if not latent:
            raise InputError("no context variable is latent", where, "leave one unmeasured")
        if not model.sensors:
            raise InputError("there is no sensor to infer a context from", where, "add sensors")
        return cls(
            sensors=tuple(model.sensors),
            contexts=tuple(model.context),
            latent=tuple(name for name in model.context if name in latent),
            ranges=tuple(variable.range for variable in model.context.values()),
        )

    @property
    def measured(self) -> tuple[str, ...]:
        """Contexts that are not inferred, in the order of the model."""
        return tuple(name for name in self.contexts if name not in self.latent)

    @cached_property
    def latent_columns(self) -> list[int]:
        """Where the latent contexts stand among all contexts."""
        return [self.contexts.index(name) for name in self.latent]

    @cached_property
    def measured_columns(self) -> list[int]:
        """Where the measured contexts stand among all contexts."""
        return [self.contexts.index(name) for name in self.measured]

    @cached_property
    def middle(self) -> FloatArray:
        """Middle of the range of each context, float[contexts]."""
        return np.asarray(np.mean(self.ranges, axis=1))

    @cached_property
    def width(self) -> FloatArray:
        """Width of the range of each context, float[contexts]."""
        return np.asarray(np.ptp(self.ranges, axis=1))

    def together(self, measured: FloatArray, latent: FloatArray) -> FloatArray:
        """All contexts in the order of the model, float[n, contexts]."""
        order = np.argsort([*self.measured_columns, *self.latent_columns])
        return np.concatenate([measured, latent], axis=1)[:, order]
