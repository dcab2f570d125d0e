"""Contexts of findings: noise of the measured, courses of the inferred, rates of lines."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.assemble.contexts import contexts, doubted_instruments
from rga.diagnosis.search.linearised import Problem
from rga.model import Model


def test_a_measured_context_has_its_noise(posed: Problem, model: Model) -> None:
    reported = contexts(posed, model)
    assert list(reported) == ["temperature", "west load", "east load"]
    assert reported["temperature"] == {
        "noise of its measurement [degC]": pytest.approx(posed.noise.context_sigma[0])
    }


def test_a_latent_one_has_its_time_history_and_a_line_its_rate(
    posed: Problem, model: Model
) -> None:
    belief = posed.data.belief
    clock = posed.data.time
    table = {**belief.table, "east load": 5.0 + 0.002 * (clock - clock[0])}
    spread = {name: one for name, one in belief.spread.items() if name != "east load"}
    other = replace(
        belief, table=table, spread=spread, latent=frozenset({"west load"}),
        lines={"east load": (10.0, 0.1)},
    )  # fmt: skip
    reported = contexts(replace(posed, data=replace(posed.data, belief=other)), model)
    assert reported["east load"]["rate [kN/s]"] == pytest.approx(0.002)
    assert reported["east load"]["at the first analysed row [kN]"] == pytest.approx(5.0)
    west = belief.table["west load"]
    assert list(reported["west load"].values()) == pytest.approx(
        [np.mean(west), np.min(west), np.max(west)]
    )


def test_an_instrument_that_sensors_deny_is_told(posed: Problem, model: Model) -> None:
    assert doubted_instruments(posed, model) == []
    off = posed.noise.context_sigma.copy()
    off[0] = 0.5 * np.std(posed.data.belief.table["temperature"])
    late = replace(posed, noise=replace(posed.noise, context_sigma=off))
    (words,) = doubted_instruments(late, model)
    assert words.startswith(
        f"temperature as measured differs from what the sensors say by {off[0]:.2g} degC"
    )
