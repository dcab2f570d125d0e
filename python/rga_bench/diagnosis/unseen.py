"""The gain of a diagnosis where its record shows nothing: on other sensors, and on other days."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rga.errors import InputError
from rga.model import Model, read_model
from rga.model.effect import Effect
from rga.simulation import Simulator
from rga_bench.diagnosis.hidden import Truth
from rga_bench.synthetic import Beyond, Case


@dataclass(frozen=True)
class UnseenGaps:
    """Mean squared distance from the truth in noise variances, where the record shows nothing.

    Of the model as given, as the diagnosis extended it, and with what is hidden in it; neither
    scatter nor the stiff joints of a frame are hidden.
    """

    given: float
    found: float
    true: float


def unseen_gaps(case: Case, found: Mapping[str, Effect]) -> UnseenGaps | None:
    """The gaps on sensors and days that the diagnosis did not get; None where nothing is known.

    Args:
        found: effects that the diagnosis added to the model.
    """
    truths, beyond = Truth.of(case), case.beyond
    if beyond is None or not truths or not all(one.can_be_simulated for one in truths):
        return None
    if case.mapping is not None:
        # The zero of the channels is that of rows which the simulation does not have.
        return None
    hidden = {f"hidden {number}": one.effect() for number, one in enumerate(truths)}
    model = read_model({**case.model, "sensors": beyond.sensors}, "challenge")
    given = _gap(beyond, model)
    try:
        true = _gap(beyond, model.extended(hidden))
    except InputError:
        # The true structure slips at members that the model has as a frame.
        return None
    try:
        gap = _gap(beyond, model.extended(dict(found)))
    except InputError:
        # What cannot be simulated there gains nothing there.
        gap = given
    return UnseenGaps(given, gap, true)


def _gap(beyond: Beyond, model: Model) -> float:
    simulated = Simulator(model).predict({**beyond.contexts, "time": beyond.time})
    noise = np.array([sensor.noise or 1.0 for sensor in model.sensors.values()])
    off = ((beyond.clean - simulated) / noise)[beyond.unseen]
    # A channel that was called broken is not simulated.
    return float((off[np.isfinite(off)] ** 2).mean())
