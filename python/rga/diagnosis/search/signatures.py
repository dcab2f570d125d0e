"""Signatures: what hypotheses change in a simulation, and how much of it moments in time take."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.errors import InputError
from rga.model.parameter import Normal
from rga.simulation.perturbation.trials import Vicinity

#: channels that a signature may name; one that touches more is written on all
FEW = 2
#: numbers in the signatures that are judged together
CHUNK = 1 << 19


@dataclass(frozen=True)
class Signature:
    """What a hypothesis changes at trial values of its parameters.

    Attributes:
        number: of the hypothesis among the candidates.
        hypothesis: itself; without onset where `values` are those of an effect that always acts.
        z: coordinates of the trial.
        channels: those that it changes, int[channels]; None: all.
        values: less what the logger's zero takes off, float[channels, rows].
        zero: what it takes off, float[channels]; an effect that begins later keeps it.
    """

    number: int
    hypothesis: Hypothesis
    z: tuple[float, ...]
    channels: IntArray | None
    values: FloatArray
    zero: FloatArray


def signature(
    data: Data, about: Vicinity, number: int, hypothesis: Hypothesis, z: tuple[float, ...]
) -> Signature | None:
    """The signature of a hypothesis about a simulation; None where it cannot be simulated.

    An onset takes its share of what the effect would change if it always acted, in the zero rows as
    in the others.
    """
    try:
        touched, change, at_zero = data.change(about, hypothesis.beginning(None).effect(z))
    except InputError:
        return None
    if hypothesis.onset is not None:
        weight, weight_at_zero = data.weights(hypothesis.effect(z))
        change = change * weight[:, None]
        at_zero = at_zero * weight_at_zero[:, None]
    zero = data.tare.mean(at_zero, data.columns[touched])
    values = (change - zero).T
    if len(touched) <= FEW:
        return Signature(number, hypothesis, z, touched, values, zero)
    if len(touched) < len(data.sensors):
        of_touched, values = values, np.zeros((len(data.sensors), len(change)))
        values[touched] = of_touched
        of_touched, zero = zero, np.zeros(len(data.sensors))
        zero[touched] = of_touched
    return Signature(number, hypothesis, z, None, values, zero)


def signatures(
    data: Data, about: Vicinity, candidates: Sequence[Hypothesis]
) -> Iterator[Signature]:
    """Signatures of all candidates at all trial values of their parameters."""
    for number, candidate in enumerate(candidates):
        for z in product(*(prior.trials for prior in candidate.priors.values())):
            found = signature(data, about, number, candidate, z)
            if found is not None:
                yield found


def chunks(several: Iterator[Signature]) -> Iterator["Block"]:
    """Signatures on equally many channels put together, in blocks of a bounded size."""
    waiting: dict[int, list[Signature]] = {}
    for one in several:
        together = waiting.setdefault(len(one.values), [])
        together.append(one)
        if len(together) * one.values.size > CHUNK:
            yield Block.of(together)
            together.clear()
    yield from (Block.of(together) for together in waiting.values() if together)


@dataclass(frozen=True)
class Block:
    """Signatures on equally many channels.

    Attributes:
        members: of each its number, hypothesis and coordinates; their own values are not kept.
        channels: int[k, channels], or None: all.
        values: less what the logger's zero takes off, float[k, channels, rows].
        zero: what it takes off, float[k, channels].
        z: float[k, parameters], zero behind the last parameter of each.
        linear: bool[k], all parameters have normal priors: the response is linear in z.
        free: bool[k], has a parameter.
        log_prior: of the hypotheses, float[k].
    """

    members: list[tuple[int, Hypothesis, tuple[float, ...]]]
    channels: IntArray | None
    values: FloatArray
    zero: FloatArray
    z: FloatArray
    linear: NDArray[np.bool_]
    free: NDArray[np.bool_]
    log_prior: FloatArray

    @classmethod
    def of(cls, several: Sequence[Signature]) -> "Block":
        """The block of signatures on equally many channels."""
        channels = [one.channels for one in several if one.channels is not None]
        z = np.zeros((len(several), max(1, *(len(one.z) for one in several))))
        for row, one in zip(z, several, strict=True):
            row[: len(one.z)] = one.z
        return cls(
            members=[(one.number, one.hypothesis, one.z) for one in several],
            channels=np.stack(channels) if channels else None,
            values=np.stack([one.values for one in several]),
            zero=np.stack([one.zero for one in several]),
            z=z,
            linear=np.array(
                [
                    all(isinstance(prior, Normal) for prior in one.hypothesis.priors.values())
                    for one in several
                ]
            ),
            free=np.array([bool(one.z) for one in several]),
            log_prior=np.array([one.hypothesis.log_prior for one in several]),
        )

    @cached_property
    def numbers(self) -> IntArray:
        """Of the hypotheses, int[k]."""
        return np.array([number for number, _, _ in self.members], dtype=np.int64)

    def along(self, weighted: FloatArray) -> FloatArray:
        """Products with a residual, row by row, float[k, rows].

        Args:
            weighted: C^-1 of the residual, float[sensors, rows].
        """
        if self.channels is None:
            return np.asarray(np.einsum("kct,ct->kt", self.values, weighted))
        return np.asarray(np.einsum("kct,kct->kt", self.values, weighted[self.channels]))

    def zero_along(self, weighted: FloatArray) -> FloatArray:
        """The same of what the logger's zero takes off, in every row, float[k, rows]."""
        if self.channels is None:
            return np.asarray(self.zero @ weighted)
        return np.asarray(np.einsum("kc,kct->kt", self.zero, weighted[self.channels]))

    def kept(self, which: NDArray[np.bool_]) -> "Block":
        """Some of the signatures, bool[k]."""
        return Block(
            members=[one for one, keep in zip(self.members, which, strict=True) if keep],
            channels=None if self.channels is None else self.channels[which],
            values=self.values[which],
            zero=self.zero[which],
            z=self.z[which],
            linear=self.linear[which],
            free=self.free[which],
            log_prior=self.log_prior[which],
        )
