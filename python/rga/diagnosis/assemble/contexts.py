"""Contexts as a diagnosis found them."""

from typing import Any

import numpy as np

from rga.diagnosis.search.linearised import Problem
from rga.model.schema import Model

#: share of a context's variation that its instrument may be off by, and times what is stated
UNSURE, BEYOND_STATED = 1 / 3, 1.5


def doubted_instruments(problem: Problem, model: Model) -> list[str]:
    """Warnings of instruments of contexts that are off by much from what the sensors say."""
    belief, warnings = problem.data.belief, []
    for number, name in enumerate(belief.spread):
        if name in belief.latent:
            continue
        off, variable = float(problem.noise.context_sigma[number]), model.context[name]
        usual = UNSURE * float(np.std(belief.table[name]))
        if off > max(usual, BEYOND_STATED * (variable.noise or 0.0)):
            warnings.append(
                f"{name} as measured differs from what the sensors say by {off:.2g} "
                f"{variable.unit} from row to row: check where its instrument is, its unit and "
                "its clock"
            )
    return warnings


def contexts(problem: Problem, model: Model) -> dict[str, dict[str, Any]]:
    """Latent contexts as they were inferred, and the noise of the measured ones."""
    found: dict[str, dict[str, Any]] = {}
    belief = problem.data.belief
    clock = problem.data.time - problem.data.time[0]
    for name in belief.lines:
        slope, level = np.polyfit(clock, belief.table[name], 1)
        unit = model.context[name].unit
        found[name] = {
            f"rate [{unit}/s]": float(slope),
            f"at the first analysed row [{unit}]": float(level),
        }
    for number, name in enumerate(belief.spread):
        unit = model.context[name].unit
        if name in belief.latent:
            column = belief.table[name]
            found[name] = {
                f"inferred mean [{unit}]": float(column.mean()),
                f"inferred smallest [{unit}]": float(column.min()),
                f"inferred largest [{unit}]": float(column.max()),
            }
        else:
            found[name] = {
                f"noise of its measurement [{unit}]": float(problem.noise.context_sigma[number])
            }
    return found
