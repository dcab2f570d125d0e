"""Contexts as a diagnosis found them."""

from typing import Any

import numpy as np

from rga.diagnosis.search.linearised import Problem
from rga.model.schema import Model


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
