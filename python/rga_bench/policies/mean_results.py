"""Means of what was measured of policies."""

from collections.abc import Callable, Sequence
from dataclasses import fields

import numpy as np

from rga_bench.policies.twin_run import PolicyResult

#: of a policy on all streams of a sort: the means of what was measured
Means = dict[str, float]


def means(played: Sequence[PolicyResult]) -> dict[tuple[str, str], Means]:
    """By stream and policy, the mean over the streams drawn of every measure."""
    places = dict.fromkeys((one.stream, one.policy) for one in sorted(played, key=_sort(played)))
    measures = [
        one.name for one in fields(PolicyResult) if one.name not in ("stream", "seed", "policy")
    ]
    return {
        place: {
            name: float(
                np.mean([getattr(p, name) for p in played if (p.stream, p.policy) == place])
            )
            for name in measures
        }
        for place in places
    }


def _sort(played: Sequence[PolicyResult]) -> Callable[[PolicyResult], int]:
    streams = list(dict.fromkeys(one.stream for one in played))
    return lambda one: streams.index(one.stream)
