"""Design-phase simulations: contexts drawn over their ranges, and what the sensors show."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.networks.dataset import Samples
from rga.inference.variables import Variables
from rga.model.schema import Model
from rga.simulation import Simulator

Box = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Design:
    """Simulated rows.

    Attributes:
        contexts: all contexts of the model in its order and units, float[n, contexts].
        readings: without noise, float[n, sensors] in the order and units of the model.
        reversed: bool[n], rows that were simulated with a latent position that falls.
    """

    contexts: FloatArray
    readings: FloatArray
    reversed: NDArray[np.bool_]

    def samples(self, variables: Variables) -> Samples:
        """The rows as a network learns from them."""
        return Samples(
            self.readings,
            self.contexts[:, variables.measured_columns],
            self.contexts[:, variables.latent_columns],
            self.reversed if self.reversed.any() else None,
        )


def design(
    model: Model,
    rows: int,
    *,
    latent: Sequence[str],
    seed: int,
    box: Box | None = None,
    time: float = 0.0,
) -> Design:
    """Draw contexts by a scrambled Sobol sequence and simulate them.

    Where a latent context of the law `linear` may rise or fall, half of the rows are simulated as
    a fall: a train that goes backwards carries its axles the other way round.

    Args:
        model: with context variables.
        rows: number of rows.
        latent: contexts that nothing measures.
        seed: of the sequence.
        box: narrower or wider ranges of some contexts.
        time: clock of all rows [s], which decides what onsets have set in.

    Raises:
        InputError: too few rows, no context, an unknown one, or an empty interval in the box.
    """
    if rows < 2 or not model.context:
        raise InputError("there is nothing to simulate", "design", "ask for 2 rows and a context")
    ranges = {name: variable.range for name, variable in model.context.items()}
    for name, interval in (box or {}).items():
        if name not in ranges:
            raise InputError(
                f"the model has no context {name!r}", "design", "it has " + ", ".join(ranges)
            )
        if not interval[0] < interval[1]:
            remedy = "give [smallest, largest]"
            raise InputError(f"the interval {list(interval)} is empty", f"design of {name}", remedy)
        ranges[name] = interval
    low, high = np.array(list(ranges.values())).T
    share = scipy.stats.qmc.Sobol(len(ranges), scramble=True, rng=seed).random(
        1 << (rows - 1).bit_length()
    )
    contexts = low + (high - low) * share[:rows]
    moving = [name for name in latent if (rate := model.context[name].rate) and rate[0] < 0]
    moving = [name for name in moving if model.context[name].law == "linear"]
    # The sequence is balanced in its halves as well as in the whole.
    falls = np.arange(rows) % 2 == 1
    parts = [(np.arange(rows), "", 1)]
    if moving:
        upward = max((model.context[moving[0]].rate or (0.0, 0.0))[1], 0.0) > 0
        falls = falls if upward else np.ones(rows, dtype=bool)
        parts = [(np.flatnonzero(~falls), moving[0], 1), (np.flatnonzero(falls), moving[0], -1)]
    else:
        falls = np.zeros(rows, dtype=bool)
    simulator, names = Simulator(model), list(ranges)
    readings = np.empty((rows, len(model.sensors)))
    for chosen, name, sign in parts:
        if len(chosen) == 0:
            continue
        order = chosen
        if name:
            order = chosen[np.argsort(sign * contexts[chosen, names.index(name)], kind="stable")]
        table = dict(zip(names, contexts[order].T, strict=True))
        readings[order] = simulator.predict({**table, "time": np.full(len(order), time)})
    return Design(contexts, readings, falls)
