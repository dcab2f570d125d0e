"""Channels whose noise is far beyond what the model states of it.

Noise is estimated from the record. A channel that wanders, or reads what has nothing to do with
the structure, shows no more than a large noise with a long memory where no other channel shows what
it should read; and so do channels that wander together. Then nothing else is off by more than that
noise, and only the stated one says that it is none.
"""

from collections.abc import Collection

from rga.diagnosis.search.linearised import Problem
from rga.findings.phrases import few_digits

#: channels that are reported by name
MOST_NAMED = 5


def beyond_stated(problem: Problem, told_already: Collection[str]) -> list[str]:
    """In words: channels whose readings vary more than their stated noise allows.

    Args:
        problem: the end of the search.
        told_already: channels that do not work for a part of the record, left out here.
    """
    model, sensors = problem.simulator.model, problem.data.sensors
    found = []
    for name, deviation in zip(sensors, problem.noise.deviation, strict=True):
        stated = model.sensors[name].noise
        if name in told_already or stated is None:
            continue
        if deviation > problem.criteria.fit.stated_noise * stated:
            size = f"{few_digits(deviation)} {model.sensors[name].unit}"
            found.append(
                f"channel {name} varies by {size} that no load explains, "
                f"{few_digits(deviation / stated)} times its stated noise"
            )
    more = len(found) - MOST_NAMED
    return found if more <= 0 else [*found[:MOST_NAMED], f"{more} more channels vary as much"]
