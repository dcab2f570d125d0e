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
#: correlation from one row to the next from which on noise wanders
WANDERS = 0.8


def beyond_stated(problem: Problem, told_already: Collection[str]) -> list[str]:
    """In words: channels whose readings vary more than their stated noise allows.

    Args:
        problem: the end of the search.
        told_already: channels that do not work for a part of the record, left out here.
    """
    model, sensors, noise = problem.simulator.model, problem.data.sensors, problem.noise
    criteria = problem.criteria.fit
    found = []
    for name, deviation, memory in zip(sensors, noise.deviation, noise.phi, strict=True):
        most = criteria.wandering_noise if memory > WANDERS else criteria.stated_noise
        stated = model.sensors[name].noise
        if name in told_already or stated is None:
            continue
        if deviation > most * stated:
            size = f"{few_digits(deviation)} {model.sensors[name].unit}"
            found.append(
                f"channel {name} varies by {size} that no load explains, "
                f"{few_digits(deviation / stated)} times its stated noise"
            )
    more = len(found) - MOST_NAMED
    return found if more <= 0 else [*found[:MOST_NAMED], f"{more} more channels vary as much"]
